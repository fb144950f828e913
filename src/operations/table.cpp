// The table of operations. A new operation needs a line here and a file of its name.
#include "ostraka/operations/table.h"

#include "ostraka/core/nearest_name.h"

namespace ostraka {

// clang-format off
std::unique_ptr<Operation> make_mesh_info(), make_mesh_convert(), make_mesh_repair(), make_mesh_simplify(),
    make_mesh_refine(), make_mesh_remesh(), make_mesh_break(), make_mesh_extract(), make_mesh_register(), make_mesh_make();
std::unique_ptr<Operation> make_annotation_apply(), make_annotation_list(), make_annotation_check(), make_annotation_remap(),
    make_annotation_select(), make_annotation_creases(), make_annotation_facets(), make_annotation_segment(), make_annotation_smooth(),
    make_annotation_transfer(), make_annotation_survival(), make_annotation_export(), make_annotation_import(),
    make_annotation_edit(), make_annotation_find(), make_annotation_diff(), make_annotation_merge(), make_annotation_infer();
std::unique_ptr<Operation> make_relation_extract(), make_relation_add(), make_relation_remove(), make_relation_edit(), make_relation_list(),
    make_relation_check(), make_relation_export();
std::unique_ptr<Operation> make_measure_take(), make_measure_describe(), make_measure_refresh(), make_measure_map(),
    make_measure_clay();
std::unique_ptr<Operation> make_vocabulary_check(), make_vocabulary_show(), make_vocabulary_convert();
std::unique_ptr<Operation> make_template_pack(), make_template_check(), make_template_show(), make_template_learn(),
    make_template_classify(), make_template_sample(), make_template_propagate(), make_template_turn();
std::unique_ptr<Operation> make_cage_make(), make_cage_edit(), make_cage_check(), make_cage_weights(), make_cage_influence();
std::unique_ptr<Operation> make_study_make_proportions(), make_study_make_moulds(), make_study_make_technique(),
    make_study_landmarks(), make_study_proportions(), make_study_moulds(), make_study_technique(), make_study_segments();
std::unique_ptr<Operation> make_axis(), make_slice(), make_deform(), make_fit(), make_pair(), make_assemble(), make_render(), make_report(), make_publish(),
    make_run(), make_replay(), make_conformance_run(), make_conformance_self(), make_operations();

namespace {
constexpr OperationEntry entries[]{
    {"mesh info", "count, measure and examine a mesh; exit code 3 if it is not closed, oriented, manifold and free of self-intersections", make_mesh_info},
    {"mesh convert", "write a mesh in another format, polygons cut into triangles, vertex order kept", make_mesh_convert},
    {"mesh repair", "make an oriented manifold; exit code 3 if it is still open or intersects itself", make_mesh_repair},
    {"mesh simplify", "fewer vertices, with annotations, labels and colours carried along", make_mesh_simplify, 2},
    {"mesh refine", "more vertices, with annotations, labels and colours carried along", make_mesh_refine, 2},
    {"mesh remesh", "a new mesh of the same surface, independent of the old one", make_mesh_remesh},
    {"mesh register", "bring a mesh onto another of the same object: rotation, translation and scale; exit code 3, and nothing written, if it is not the same object", make_mesh_register},
    {"mesh extract", "cut annotated parts out of an object, with what is annotated on them", make_mesh_extract},
    {"mesh break", "break a piece off an object: a fragment whose pose on the whole is known", make_mesh_break},
    {"mesh make", "make a closed mesh of an object whose parts are known exactly", make_mesh_make},
    {"annotation apply", "annotate a mesh by a recipe or from labels", make_annotation_apply, 3},
    {"annotation list", "what is annotated", make_annotation_list},
    {"annotation check", "look for defects in annotations; exit code 3 if there are", make_annotation_check},
    {"annotation remap", "carry annotations or labels along the maps of 'mesh repair'", make_annotation_remap, 2},
    {"annotation select", "select a part by one tool and annotate it, or edit an annotation", make_annotation_select, 3},
    {"annotation creases", "find ridges and hollows of the surface, such as clay leaves at joints; exit code 3 if there is none", make_annotation_creases},
    {"annotation facets", "tell the outer, inner and fracture surface of a fragment apart; exit code 3 if there is no fracture", make_annotation_facets},
    {"annotation segment", "cut a mesh into parts of like thickness, each an annotation", make_annotation_segment},
    {"annotation smooth", "outlines and lines without the steps of the edges: fair curves through the faces", make_annotation_smooth, 2},
    {"annotation transfer", "carry annotations to another resolution of the same object, and say how faithful they are", make_annotation_transfer, 3},
    {"annotation survival", "the smallest resolution at which each annotation survives", make_annotation_survival},
    {"annotation export", "write annotations in the formats of other tools", make_annotation_export, 2},
    {"annotation import", "read annotations from the formats of other tools", make_annotation_import},
    {"annotation edit", "change tags, colours, ids, attributes, the file's class, unit and up; remove, duplicate, merge, split", make_annotation_edit},
    {"annotation find", "which objects have such parts, attributes and relationships; exit code 3 if none has", make_annotation_find},
    {"annotation diff", "what differs between two sets of annotations; exit code 3 if they do", make_annotation_diff},
    {"annotation merge", "join two people's changes of one set; exit code 3 and no output with conflicts", make_annotation_merge},
    {"annotation infer", "words from numbers, by the rules of a vocabulary; exit code 3 if they contradict each other", make_annotation_infer},
    {"relation extract", "find relationships among annotations", make_relation_extract},
    {"relation add", "state a relationship", make_relation_add},
    {"relation remove", "take relationships out of a graph", make_relation_remove},
    {"relation edit", "change weight, range and parameters of a relationship in place", make_relation_edit},
    {"relation list", "the relationships of a graph", make_relation_list},
    {"relation check", "tell which relationships hold on a mesh; exit code 3 if one fails", make_relation_check},
    {"relation export", "draw a graph, or write it for Graphviz", make_relation_export},
    {"measure take", "take one measure by ruler, tape or bounding planes", make_measure_take},
    {"measure describe", "sizes, box, centroid, volume, curvature, thickness, and statistics of maps, of annotations", make_measure_describe},
    {"measure refresh", "compute all measures and descriptors anew, with uncertainties; exit code 3 if some cannot be", make_measure_refresh},
    {"measure map", "write a map of curvature, thickness or distance", make_measure_map},
    {"measure clay", "volume of clay, between what it is if the unseen inside is solid and if it is hollow", make_measure_clay},
    {"vocabulary check", "look for defects in a vocabulary; exit code 3 if there are", make_vocabulary_check},
    {"vocabulary show", "concepts as a tree, with the attributes each may carry", make_vocabulary_show},
    {"vocabulary convert", "vocabularies between our format and SKOS", make_vocabulary_convert},
    {"template pack", "one file that names the parts of a template, checked as a whole; exit code 3, and nothing written, if they do not fit", make_template_pack},
    {"template check", "look at a template as a whole; exit code 3 if something is wrong", make_template_check},
    {"template show", "what a template holds, and what is wrong with it", make_template_show},
    {"template learn", "learn a class from members of it: ranges of what is measured, mean shape, modes of variation, archetype, thresholds", make_template_learn},
    {"template classify", "say which class objects belong to, and which proportion, relation or distance speaks against it (exit code 3: one belongs to none, or it cannot be told)", make_template_classify},
    {"template sample", "draw new members of a class, kept where its constraints hold (exit code 3: fewer than wanted)", make_template_sample},
    {"template propagate", "lay a template onto members of its class and carry its annotations to them (exit code 3: some are lost, or the template does not lie on a member)", make_template_propagate},
    {"template turn", "a whole vessel from its sherds: turned about their axis, with its profile", make_template_turn},
    {"cage make", "a closed coarse mesh strictly around a mesh", make_cage_make},
    {"cage edit", "move the vertices of a cage by an edit file", make_cage_edit},
    {"cage check", "is a mesh a sound cage of another? (exit code 3: no)", make_cage_check, 2},
    {"cage weights", "coordinates of a mesh in a cage, with a certificate", make_cage_weights, 2},
    {"cage influence", "colour a mesh, or its cage, by who moves what", make_cage_influence},
    {"study make proportions", "statuettes with annotations some of whose proportions are fixed, and the measures that find them", make_study_make_proportions},
    {"study make moulds", "heads of figurines cast from a few moulds, each worn, pressed and scanned on its own", make_study_make_moulds, 2},
    {"study make technique", "statuettes thrown on the wheel and built by hand, with their annotations", make_study_make_technique},
    {"study landmarks", "lay the landmarks of a collection over each other (generalised Procrustes analysis): mean shape, sizes, principal components", make_study_landmarks},
    {"study proportions", "which ratios of measures are fixed over a collection (or a table of measures, .csv); exit code 3 if none is", make_study_proportions},
    {"study moulds", "which heads come from one mould", make_study_moulds},
    {"study technique", "which bodies are wheel-made and which hand-made, by their lower slices", make_study_technique},
    {"study segments", "an object in segments along its height, by clusters of its slices", make_study_segments},
    {"axis", "the axis of an object or of an annotated part; exit code 3 if it has none", make_axis},
    {"slice", "cut an object into slices, describe and draw them; exit code 3 if no plane meets it", make_slice},
    {"deform", "edit a shape so that its meaning survives (exit code 3: a constraint does not hold)", make_deform},
    {"fit", "complete an object from fragments by a template of its class, and say whether they go together (exit code 3: they do not, or it cannot be told)", make_fit, 2},
    {"pair", "lay two fragments together by the break they share; exit code 3 if it cannot be told how", make_pair},
    {"assemble", "put a box of fragments together by their breaks, leave out what does not belong, and say how sure each join is; exit code 3 if nothing is joined", make_assemble, 2},
    {"render", "make a picture of meshes, their annotations and maps", make_render},
    {"publish", "write an annotated object as a folder that any web server serves: IIIF manifest, GLB with features, annotations, a page", make_publish},
    {"report", "make one HTML page of results that opens anywhere: objects in 3D, tables, drawings", make_report, 2},
    {"run", "run the steps of a study file; what has not changed is not run again (exit code 3: a step failed)", make_run, 1, true},
    {"replay", "repeat a run of a study and compare all that it made, to the bit; exit code 3 if something differs", make_replay, 1, true},
    {"conformance run", "give the golden cases to another program, and say where it agrees (exit code 3: somewhere it does not)", make_conformance_run, 1, true},
    {"conformance self", "the golden cases by this command; exit code 3 if one differs", make_conformance_self, 1, true},
    {"operations", "what the toolkit can do: every operation with its inputs, outputs, options, ranges, defaults and units", make_operations},
};
// clang-format on
const OperationGroup groups[]{
    {"mesh", "examine, repair, convert, resize and make meshes"},
    {"annotation", "annotate meshes and carry annotations between them"},
    {"relation", "relationships among annotations"},
    {"measure", "take measures, describe annotations, compute maps"},
    {"vocabulary", "the words that tags and attributes are taken from"},
    {"template", "the files of a template, as one"},
    {"cage", "cages around meshes, and coordinates in them"},
    {"study", "questions to a whole collection of objects"},
    {"conformance", "whether other programs do what this one does"},
    {"study make", "collections whose answers are known, to try a study on"},
};
}  // namespace

std::span<const OperationEntry> operations() { return entries; }
std::span<const OperationGroup> operation_groups() { return groups; }

const OperationEntry& find_operation(const std::string& name) {
    std::vector<std::string> names;
    for (const OperationEntry& entry : entries) {
        if (name == entry.name) return entry;
        names.emplace_back(entry.name);
    }
    const std::string near = nearest_name(name, names);
    throw Error(ErrorKind::usage, "", "there is no operation '" + printable(name, 60) + "'",
                near.empty() ? "'ostraka operations' lists them" : "did you mean '" + near + "'?");
}

}  // namespace ostraka
