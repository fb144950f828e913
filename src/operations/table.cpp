// The table of operations. A new operation needs a line here and a file of its name.
#include "ostraka/operations/table.h"

#include "ostraka/core/nearest_name.h"

#include <fmt/core.h>

namespace ostraka {

// clang-format off
std::unique_ptr<Operation> make_mesh_info(), make_mesh_convert(), make_mesh_repair(), make_mesh_simplify(),
    make_mesh_refine(), make_mesh_remesh(), make_mesh_break(), make_mesh_extract(), make_mesh_register(), make_mesh_make(),
    make_mesh_surface(), make_mesh_move(), make_mesh_bake();
std::unique_ptr<Operation> make_annotation_apply(), make_annotation_list(), make_annotation_check(), make_annotation_remap(),
    make_annotation_select(), make_annotation_creases(), make_annotation_facets(), make_annotation_segment(), make_annotation_smooth(),
    make_annotation_transfer(), make_annotation_survival(), make_annotation_export(), make_annotation_import(),
    make_annotation_edit(), make_annotation_find(), make_annotation_diff(), make_annotation_merge(), make_annotation_infer();
std::unique_ptr<Operation> make_relation_extract(), make_relation_add(), make_relation_remove(), make_relation_edit(), make_relation_list(),
    make_relation_check(), make_relation_export();
std::unique_ptr<Operation> make_measure_take(), make_measure_describe(), make_measure_refresh(), make_measure_map(),
    make_measure_clay(), make_measure_capacity(), make_measure_distance();
std::unique_ptr<Operation> make_vocabulary_check(), make_vocabulary_show(), make_vocabulary_convert();
std::unique_ptr<Operation> make_template_pack(), make_template_check(), make_template_show(), make_template_learn(),
    make_template_classify(), make_template_sample(), make_template_propagate(), make_template_revolve();
std::unique_ptr<Operation> make_cage_make(), make_cage_edit(), make_cage_check(), make_cage_weights(), make_cage_influence();
std::unique_ptr<Operation> make_study_make_proportions(), make_study_make_moulds(), make_study_make_technique(),
    make_study_landmarks(), make_study_proportions(), make_study_moulds(), make_study_technique(), make_study_segments(), make_study_shape();
std::unique_ptr<Operation> make_import(), make_catalogue(), make_axis(), make_slice(), make_deform(), make_fit(), make_pair(), make_assemble(), make_render(), make_report(), make_publish(),
    make_run(), make_replay(), make_conformance_run(), make_conformance_self(), make_operations();

namespace {
constexpr OperationEntry entries[]{
    {"mesh info", "report counts, measures and defects of a mesh; exit code 3 if the mesh is not closed, oriented, manifold and free of self-intersections", make_mesh_info, 2},
    {"mesh convert", "write a mesh in another format, with polygons triangulated and the vertex order kept", make_mesh_convert},
    {"mesh repair", "repair a mesh to an oriented manifold; exit code 3 if the repaired mesh is still open or intersects itself", make_mesh_repair},
    {"mesh simplify", "reduce the number of vertices, with annotations, labels and colours transferred", make_mesh_simplify, 5},
    {"mesh refine", "increase the number of vertices, with annotations, labels and colours transferred", make_mesh_refine, 2},
    {"mesh remesh", "replace the mesh by new, nearly equilateral triangles of the same surface, with texture or colours baked from the old mesh", make_mesh_remesh, 2},
    {"mesh bake", "bake the texture, colours, occlusion, curvature or relief of a mesh into an image or the vertex colours of another mesh of the same object", make_mesh_bake, 2},
    {"mesh register", "register a mesh to another mesh of the same object by rotation, translation and scale; exit code 3, and nothing written, if the meshes show different objects", make_mesh_register, 3},
    {"mesh move", "translate, rotate, scale or mirror a mesh, or change its unit or axes, together with annotations, relationships and cage", make_mesh_move},
    {"mesh extract", "cut annotated parts out of a mesh, with the annotations of these parts", make_mesh_extract},
    {"mesh break", "break a piece off an object: a fragment with known pose", make_mesh_break},
    {"mesh surface", "reconstruct the surface of a point cloud, with the colours and intensities of its points", make_mesh_surface, 2},
    {"mesh make", "make a closed mesh of a synthetic object, with the exact label of each part", make_mesh_make},
    {"annotation apply", "annotate a mesh from a recipe or from labels", make_annotation_apply, 4},
    {"annotation list", "list the annotations of a mesh", make_annotation_list},
    {"annotation check", "check annotations for defects; exit code 3 if there are any", make_annotation_check},
    {"annotation remap", "transfer annotations or labels with the index maps of 'mesh repair'", make_annotation_remap, 2},
    {"annotation select", "select a part of the mesh with one tool and annotate it, or edit an annotation", make_annotation_select, 4},
    {"annotation creases", "find ridges and valleys of the surface, for example along joints of clay parts, or edges in its image; exit code 3 if there are none", make_annotation_creases, 2},
    {"annotation facets", "classify the surface of a fragment as outer, inner and fracture surface; exit code 3 if there is no fracture", make_annotation_facets, 2},
    {"annotation segment", "segment a mesh by thickness; each segment becomes an annotation", make_annotation_segment, 2},
    {"annotation smooth", "replace outlines and lines along edges by fair curves through the faces", make_annotation_smooth, 2},
    {"annotation transfer", "transfer annotations to another resolution of the same object, and report the fidelity", make_annotation_transfer, 4},
    {"annotation survival", "find the smallest resolution at which each annotation survives", make_annotation_survival},
    {"annotation export", "write annotations in the formats of other tools", make_annotation_export, 2},
    {"annotation import", "read annotations from the formats of other tools", make_annotation_import, 2},
    {"annotation edit", "edit annotations (tag, colour, id, attributes; remove, duplicate, merge, split), or the class, unit and upward direction of the file", make_annotation_edit},
    {"annotation find", "find objects by their parts, attributes and relationships; exit code 3 if no object is found", make_annotation_find},
    {"annotation diff", "list the differences between two sets of annotations; exit code 3 if there are any", make_annotation_diff},
    {"annotation merge", "merge two changed versions of one set of annotations; exit code 3 and no output if there are conflicts", make_annotation_merge},
    {"annotation infer", "derive qualitative attributes from quantities by the rules of a vocabulary; exit code 3 if rules contradict each other", make_annotation_infer},
    {"relation extract", "find the relationships that hold among annotations", make_relation_extract},
    {"relation add", "add a user-specified relationship", make_relation_add},
    {"relation remove", "remove relationships from a graph", make_relation_remove},
    {"relation edit", "change the weight, range and parameters of a relationship, and keep its id", make_relation_edit},
    {"relation list", "list the relationships of a graph", make_relation_list},
    {"relation check", "check which relationships hold on a mesh; exit code 3 if a relationship or rule fails", make_relation_check, 2},
    {"relation export", "draw the relationships as a graph, or write the graph for Graphviz", make_relation_export},
    {"measure take", "take a measure of a mesh or an annotation with a ruler, a tape or bounding planes", make_measure_take},
    {"measure describe", "compute descriptors of annotations: sizes, box, centroid, volume, curvature, thickness, and statistics of maps", make_measure_describe, 2},
    {"measure refresh", "recompute the measures and descriptors of all annotations, with uncertainties; exit code 3 if some cannot be computed", make_measure_refresh, 2},
    {"measure map", "compute curvature, thickness, geodesic distance, volumes in balls of several radii, ambient occlusion or sky view at every vertex (thickness also at faces), and write the values (a map)", make_measure_map, 3},
    {"measure clay", "compute bounds of the clay volume of an object, under the assumptions that its unscanned interior is solid and that it is hollow", make_measure_clay, 2},
    {"measure capacity", "compute the volume of liquid that a vessel holds before it overflows, or up to a level; exit code 3 if it holds none or the volume cannot be told", make_measure_capacity},
    {"measure distance", "measure the signed distance between two registered scans of an object: statistics, tolerances, significance against the noise of both, a map, a picture", make_measure_distance},
    {"vocabulary check", "check a vocabulary for defects; exit code 3 if there are any", make_vocabulary_check},
    {"vocabulary show", "show the concepts of a vocabulary as a tree, with the attributes that each concept permits", make_vocabulary_show},
    {"vocabulary convert", "convert a vocabulary between Ostraka's format and SKOS", make_vocabulary_convert},
    {"template pack", "check the files of a template together and write one file that lists them; exit code 3, and nothing written, if the files are inconsistent", make_template_pack},
    {"template check", "check all files of a template together; exit code 3 if there are defects", make_template_check},
    {"template show", "show the contents of a template and its defects", make_template_show},
    {"template learn", "learn a class from its members: ranges of measures, mean shape, modes of variation, archetype, thresholds", make_template_learn, 3},
    {"template classify", "classify objects, and report the proportions, relations or distances that contradict a class (exit code 3: an object belongs to no class, or is undecided)", make_template_classify, 2},
    {"template sample", "sample random new members of a class that satisfy the constraints of the class (exit code 3: fewer members than requested)", make_template_sample},
    {"template propagate", "fit a template to members of its class and transfer its annotations to the members (exit code 3: annotations are lost, or the template does not fit a member)", make_template_propagate, 2},
    {"template revolve", "reconstruct a whole vessel from its sherds as a surface of revolution, with its profile", make_template_revolve, 2},
    {"cage make", "make a closed coarse mesh strictly around a mesh", make_cage_make},
    {"cage edit", "move the vertices of a cage as an edit file specifies", make_cage_edit},
    {"cage check", "check whether one mesh is a sound cage of another mesh (exit code 3: it is not)", make_cage_check, 2},
    {"cage weights", "compute the coordinates of mesh vertices in a cage, with a certificate of their properties", make_cage_weights, 2},
    {"cage influence", "colour a mesh or its cage by the weights of cage vertices", make_cage_influence},
    {"study make proportions", "make synthetic annotated statuettes with some fixed proportions, and a file of measure definitions", make_study_make_proportions},
    {"study make moulds", "make synthetic heads of figurines cast from a few moulds; each cast is worn, deformed and scanned separately", make_study_make_moulds, 2},
    {"study make technique", "make synthetic statuettes, wheel-made and hand-made, with their annotations", make_study_make_technique},
    {"study landmarks", "compute a generalised Procrustes analysis of the landmarks of a collection: mean shape, sizes, principal components, doubtful specimens", make_study_landmarks, 2},
    {"study shape", "test what the shape of landmarks depends on: Procrustes analysis of variance, allometry, symmetry, error of measurement", make_study_shape},
    {"study proportions", "find ratios of measures that are fixed in a collection (or a table of measures, .csv); exit code 3 if no ratio is fixed", make_study_proportions},
    {"study moulds", "group heads by the mould from which they were cast", make_study_moulds, 2},
    {"study technique", "classify bodies as wheel-made or hand-made from their lower slices", make_study_technique},
    {"study segments", "segment an object along its height by clustering its slices", make_study_segments},
    {"import", "read scans as they come, meshes with their images and point clouds; repair them as far as needed, and keep the raw files and index maps beside them; exit code 3 if an object is still open or intersects itself, or if a scan was refused", make_import, 2},
    {"axis", "compute the axis of an object or of an annotated part; exit code 3 if there is no axis, or the diameter cannot be told", make_axis, 4},
    {"slice", "slice an object with planes, describe and draw the slices; exit code 3 if no plane intersects the object", make_slice, 3},
    {"deform", "deform a mesh while constraints on its parts are satisfied (exit code 3: the result is not acceptable)", make_deform, 2},
    {"fit", "complete an object from fragments with a template of its class, and report whether the fragments are compatible with each other and the template (exit code 3: incompatible or undecided)", make_fit, 4},
    {"pair", "register two fragments along their common fracture surface; exit code 3 if there is no answer", make_pair, 2},
    {"assemble", "join fragments along their fracture surfaces, leave out unrelated fragments, and report the probability of each join; exit code 3 if no fragments are joined", make_assemble, 3},
    {"render", "render a picture of meshes with their annotations and maps", make_render, 2},
    {"catalogue", "print a catalogue of a folder of scans: drawings of vessels and sherds at a scale, views, measures and what cannot be told, one page for each object or sheets of many, and a table of all; exit code 3 if no object can be read", make_catalogue, 3},
    {"publish", "write an annotated object as a folder for any web server: IIIF manifest, GLB with features, annotations and an HTML page", make_publish, 2},
    {"report", "make a self-contained HTML page that shows results: objects in 3D, tables, drawings", make_report, 3},
    {"run", "run the steps of a study file, except steps that are unchanged since the last run (exit code 3: a step failed)", make_run, 1, true},
    {"replay", "repeat a run of a study and compare every output with the first run, bit by bit; exit code 3 if an output differs", make_replay, 1, true},
    {"conformance run", "run the test cases of the conformance kit with another program, and compare its results with the expected results (exit code 3: some differ)", make_conformance_run, 1, true},
    {"conformance self", "run the test cases of the conformance kit with this command; exit code 3 if a result differs from the expected result", make_conformance_self, 1, true},
    {"operations", "list all operations with their inputs, outputs and options, and the range, default and unit of each option", make_operations},
};
// clang-format on
const OperationGroup groups[]{
    {"mesh", "examine, repair, convert, resize and make meshes"},
    {"annotation", "annotate meshes and transfer annotations between them"},
    {"relation", "extract, edit, check and draw relationships among annotations"},
    {"measure", "measures of objects and annotations, descriptors, maps of quantities over the surface"},
    {"vocabulary", "controlled vocabularies of tags and attributes"},
    {"template", "templates, and classes learnt from their members"},
    {"cage", "cages around meshes, and coordinates in them"},
    {"study", "statistical analyses of a collection of objects"},
    {"conformance", "tests whether other programs give the same results"},
    {"study make", "synthetic collections with known ground truth, to test studies"},
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
    const std::string nearest = nearest_name(name, names);
    throw Error(ErrorKind::usage, "", fmt::format("there is no operation '{}'", printable(name, 60)),
                nearest.empty() ? "'ostraka operations' lists them" : fmt::format("did you mean '{}'?", nearest));
}

}  // namespace ostraka
