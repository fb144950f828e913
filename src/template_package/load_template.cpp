// Checks the parts of a template, separately and together.
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/files/npy.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/relation/rules.h"
#include "ostraka/template_package/template.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace ostraka {

namespace {

using std::to_string;

class Loader {
public:
    Loader(TemplateFile file, const TemplateOptions& options) : options_(options) { result_.file = std::move(file); }

    Template run() {
        // In this order, since later parts are checked against earlier ones.
        for (const std::string& role : template_roles())
            for (const PackagedFile* part : result_.file.of(role)) load_part(*part);
        if (result_.annotations) compare_with_annotations();
        if (result_.annotations && result_.vocabulary) check_terms();
        if (result_.annotations && result_.rules) class_rules();
        return std::move(result_);
    }

private:
    void defect(const std::string& part, const std::string& text) { result_.findings.push_back({true, part, text}); }
    void remark(const std::string& part, const std::string& text) { result_.findings.push_back({false, part, text}); }

    void load_part(const PackagedFile& part) {
        TemplateEntry entry{part.role, part.name, 0, {}};
        if (part.role == "cage") result_.cages.emplace_back();
        try {
            const bool exists = file_exists(part.file);
            if (exists) entry.bytes = size_of_file(part.file);
            if (part.sha256.empty()) remark(part.name, "the template contains no checksum for it");
            else if (exists && sha256_of_file(part.file) != part.sha256)
                defect(part.name, "the file has changed since the template was packed (its checksum differs)");
            entry.text = read(part);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::failure || error.kind() == ErrorKind::cancelled) throw;
            // The finding already names the part.
            std::string where = error.where();
            if (where.starts_with(part.file.string())) where.erase(0, part.file.string().size());
            where.erase(0, where.find_first_not_of(", :"));
            defect(part.name, (where.empty() ? "" : where + ": ") + error.problem() +
                                  (error.remedy().empty() ? "" : fmt::format(" ({})", error.remedy())));
            entry.text = "cannot be read";
        }
        result_.entries.push_back(std::move(entry));
    }

    std::string read(const PackagedFile& part) {
        if (part.role == "mesh") return read_mesh_part(part);
        if (part.role == "annotations") return read_annotation_part(part);
        if (part.role == "graph") return read_graph_part(part);
        if (part.role == "cage") return read_cage(part);
        if (part.role == "coordinates") return read_coordinates(part);
        if (part.role == "landmarks") return read_landmarks(part);
        if (part.role == "vocabulary") {
            result_.vocabulary = read_vocabulary(part.file);
            return counted(result_.vocabulary->concepts.size(), "concept");
        }
        if (part.role == "rules") {
            result_.rules = read_class_rules(part.file);
            return counted(result_.rules->rules.size(), "rule");
        }
        (void)read_json(part.file);
        return "JSON";
    }

    std::string read_mesh_part(const PackagedFile& part) {
        result_.mesh = read_mesh(part.file);
        for (const auto& note : result_.mesh->notes) remark(part.name, note);
        return size_of(result_.mesh->mesh);
    }
    static std::string size_of(const Mesh& mesh) {
        return fmt::format("{} vertices, {} faces", mesh.number_of_vertices(), mesh.number_of_faces());
    }

    std::string read_annotation_part(const PackagedFile& part) {
        if (!result_.mesh) return "not checked: there is no mesh to compare them with";
        result_.annotations = read_annotations(part.file, result_.mesh->mesh, {options_.force_mesh});
        for (const auto& note : result_.annotations->notes) remark(part.name, note);
        for (const Annotation& annotation : result_.annotations->annotations)
            for (const Attribute& attribute : annotation.attributes) {
                if (attribute.descriptor() == nullptr || attribute.descriptor()->file.empty()) continue;
                const std::string& array = attribute.descriptor()->file;
                const std::string at = fmt::format("the attribute '{}'", attribute.name);
                if (!options_.allow_outside) try {
                        (void)file_inside(array, part.file.parent_path(), part.name, at, "the folder of the annotations",
                                          "move the array into the folder, or allow it with --allow-outside");
                    } catch (const Error& error) {
                        defect(part.name, fmt::format("{} ({})", error.problem(), error.remedy()));
                        continue;
                    }
                if (!file_exists(part.file.parent_path() / array))
                    remark(part.name, fmt::format("the array '{}' of the attribute '{}' is missing", array, attribute.name));
            }
        return counted(result_.annotations->annotations.size(), "annotation");
    }

    std::string read_graph_part(const PackagedFile& part) {
        if (!result_.annotations) return "not checked: there are no annotations to compare it with";
        result_.graph = read_graph(part.file, *result_.annotations);
        const auto constraints = std::count_if(result_.graph->relationships.begin(), result_.graph->relationships.end(),
                                               [](const Relationship& relationship) { return relationship.is_constraint; });
        return fmt::format("{}, {}", counted(result_.graph->relationships.size(), "relationship"),
                           counted(static_cast<std::size_t>(constraints), "constraint"));
    }

    std::string read_cage(const PackagedFile& part) {
        MeshFile file = read_mesh(part.file);
        std::string text = size_of(file.mesh);
        if (result_.mesh) {
            const CageCheck cage_check = check_cage(file.mesh, result_.mesh->mesh);
            if (!cage_check.closed) defect(part.name, "the cage is not closed: it has a border");
            else if (cage_check.flat) defect(part.name, "the cage has no face with an area");
            else if (!cage_check.outward) defect(part.name, "the cage is inside out");
            else if (!cage_check.encloses()) {
                const std::size_t outside_count = cage_check.outside.size() - cage_check.touching;
                const std::string problem = outside_count > 0 ? to_string(outside_count) + " vertices of the mesh lie outside"
                                            : cage_check.touching > 0
                                                ? to_string(cage_check.touching) + " vertices of the mesh lie on it"
                                                : std::string("faces of the mesh cross it");
                remark(part.name, "the cage does not enclose the mesh: " + problem);
                text += ", " + problem;
            } else {
                text += ", encloses the mesh";
            }
            if (!cage_check.intersections.empty())
                remark(part.name, fmt::format("the cage intersects itself, at {} of its faces",
                                              counted(cage_check.intersections.size(), "pair")));
        }
        result_.cages.back() = std::move(file.mesh);
        return text;
    }

    std::string read_coordinates(const PackagedFile& part) {
        // The index files of sparse weights belong to the header of the weights and are read with them.
        if (part.name.ends_with(".columns.npy") || part.name.ends_with(".rows.npy")) {
            static_cast<void>(read_npy_integers(part.file));
            return "indices of sparse weights";
        }
        const std::vector<std::size_t> shape = shape_of(part.file);
        if (result_.mesh && shape[0] != result_.mesh->mesh.number_of_vertices())
            defect(part.name, fmt::format("the coordinates have {} rows, but the mesh has {} vertices", shape[0],
                                          result_.mesh->mesh.number_of_vertices()));
        bool fits = false, has_cage = false;
        for (const auto& cage : result_.cages)
            if (cage)
                has_cage = true, fits = fits || shape[1] == cage->number_of_vertices() || shape[1] == cage->number_of_faces();
        if (has_cage && !fits)
            defect(part.name,
                   fmt::format("the coordinates have {} columns, which matches neither the vertices nor the faces of any cage",
                               shape[1]));
        if (result_.cages.empty()) defect(part.name, "coordinates without a cage");
        check_header(part);
        return fmt::format("{} x {}", shape[0], shape[1]);
    }

    /// If there is a header beside the weights, it names the mesh and the cage.
    void check_header(const PackagedFile& part) {
        if (!file_exists(coordinate_header_file(part.file))) {
            // The second array of Green coordinates shares the header of the first.
            if (!part.name.ends_with(".normal.npy"))
                remark(part.name, fmt::format("has no header {} that identifies its mesh and cage",
                                              coordinate_header_file(part.file).filename().string()));
            return;
        }
        const CoordinateHeader header = read_coordinate_header(part.file);
        if (sha256_of_file(part.file) != header.vertex.sha256) defect(part.name, "its header was written for another array");
        if (result_.mesh && header.mesh.sha256 != mesh_checksum(result_.mesh->mesh))
            defect(part.name, "its header says that it was computed for another mesh");
        bool has_cage = false, matches = false;
        for (const auto& cage : result_.cages)
            if (cage) has_cage = true, matches = matches || header.cage.sha256 == mesh_checksum(*cage);
        if (has_cage && !matches) defect(part.name, "its header says that it was computed for another cage");
    }

    /// Shape of the weights; for sparse weights from their header.
    static std::vector<std::size_t> shape_of(const Path& file) {
        if (file_exists(coordinate_header_file(file)))
            if (const CoordinateHeader header = read_coordinate_header(file); header.sparse)
                return {header.mesh.vertices, header.sparse->columns};
        return shape_of_matrix(file);
    }

    static std::vector<std::size_t> shape_of_matrix(const Path& file) {
        const std::string bytes = read_file(file);
        const NpyView view = view_npy(bytes, file.string());
        if (view.shape.size() != 2) fail_input(file.string(), "the array has one dimension, not two");
        if (view.type != "<f8")
            fail_input(file.string(), "the array does not contain little-endian float64 numbers",
                       "write it with numpy.save, as float64");
        for (std::size_t i = 0; i < view.count(); ++i) {
            double value = 0;
            std::memcpy(&value, view.data.data() + i * sizeof value, sizeof value);
            if (!std::isfinite(value))
                fail_input(file.string(), fmt::format("number {} of the array is not finite", i), "compute it again");
        }
        return view.shape;
    }

    std::string read_landmarks(const PackagedFile& part) {
        const std::string ending = extension(part.file);
        if (ending != ".json" && ending != ".ant") {
            (void)read_file(part.file);
            remark(part.name, fmt::format("landmarks with the extension '{}' are not checked", ending));
            return "not checked";
        }
        if (!result_.mesh) return "not checked: there is no mesh to compare them with";
        const AnnotationSet set = read_annotations(part.file, result_.mesh->mesh, {options_.force_mesh});
        std::size_t points = 0;
        for (const Annotation& annotation : set.annotations) points += annotation.type == AnnotationType::point;
        if (points == 0) defect(part.name, "contains no point annotation");
        return counted(points, "landmark");
    }

    /// Compares template and annotations. The template's values are used; a remark names both. Different units are a defect,
    /// since measures would be misread.
    void compare_with_annotations() {
        AnnotationSet& set = *result_.annotations;
        const TemplateFile& file = result_.file;
        const std::string name = file.of("annotations").front()->name;
        const auto differ = [&](const std::string& property, const std::string& template_value,
                                const std::string& annotation_value) {
            remark(name, fmt::format("the {} of the annotations is {}, that of the template {}: the template's is used", property,
                                     annotation_value, template_value));
        };
        if (!file.unit.empty() && !set.unit.empty() && file.unit != set.unit)
            defect(name, fmt::format("the unit of the annotations is '{}', that of the template '{}': a mesh has only one unit",
                                     set.unit, file.unit));
        if (!file.object_class.empty() && !set.object_class.empty() && file.object_class != set.object_class)
            differ("class", fmt::format("'{}'", file.object_class), fmt::format("'{}'", set.object_class));
        if (file.up && set.up) {
            const auto &a = *file.up, &b = *set.up;
            if (!(unit_vector({a[0], a[1], a[2]}) * unit_vector({b[0], b[1], b[2]}) >= 1 - 1e-9))
                differ("upward direction", text_of(a), text_of(b));
        }
        if (!file.unit.empty()) set.unit = file.unit;
        if (!file.object_class.empty()) set.object_class = file.object_class;
        if (file.up) set.up = file.up;
    }
    static std::string text_of(const std::array<double, 3>& v) {
        return fmt::format("({})", joined(std::array{digits(v[0], 6), digits(v[1], 6), digits(v[2], 6)}));
    }

    void check_terms() {
        const std::string name = result_.file.of("annotations").front()->name;
        for (const auto& finding : check_against_vocabulary(*result_.annotations, *result_.vocabulary))
            result_.findings.push_back({finding.defect, name, fmt::format("at {}: {}", finding.where, finding.text)});
        const std::string& name_of_class = result_.annotations->object_class;
        if (!name_of_class.empty() && !VocabularySearch(*result_.vocabulary).concept_of(name_of_class))
            remark(name, fmt::format("the class '{}' is not a concept of the vocabulary", name_of_class));
    }

    void class_rules() {
        const PackagedFile& part = *result_.file.of("rules").front();
        const Vocabulary* vocabulary = result_.vocabulary ? &*result_.vocabulary : nullptr;
        const RelationGraph* graph = result_.graph ? &*result_.graph : nullptr;
        try {
            for (const RuleViolation& violation :
                 broken_rules({result_.mesh->mesh, *result_.annotations}, *result_.rules, vocabulary, graph, part.name))
                defect(result_.file.of("annotations").front()->name,
                       fmt::format("rule '{}': {}", violation.rule, violation.text));
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
            defect(part.name, error.problem());
        }
    }

    TemplateOptions options_;
    Template result_;
};

}  // namespace

bool Template::sound() const {
    return std::none_of(findings.begin(), findings.end(), [](const Finding& finding) { return finding.defect; });
}

Template load_template(TemplateFile file, const TemplateOptions& options) { return Loader(std::move(file), options).run(); }

void check_usable(const Template& loaded, const std::string& file) {
    for (const Finding& finding : loaded.findings)
        if (finding.defect)
            fail_input(fmt::format("{}, {}", file, finding.where), finding.text, "'template check' lists all defects");
    if (!loaded.mesh) fail_input(file, "has no mesh", "pack one");
}

}  // namespace ostraka
