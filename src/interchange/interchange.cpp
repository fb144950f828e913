#include "ostraka/interchange/interchange.h"

#include "interchange/landmark_formats.h"

#include "interchange/attribute_table.h"
#include "interchange/prototype_files.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/interchange/feature_glb.h"
#include "ostraka/interchange/web_annotation.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

namespace {

/// In the order of interchange_formats(); the landmark formats are in the order of LandmarkFormat.
enum class Format { attributes_csv, landmarks_csv, tps, pp, mrk, fcsv, web, glb, ant, fct };

Format format_named(const std::string& name) {
    const auto& names = interchange_formats();
    if (const auto match = std::find(names.begin(), names.end(), name); match != names.end())
        return static_cast<Format>(match - names.begin());
    fail_usage(fmt::format("unknown format '{}'", name), "use one of: " + joined(names));
}

std::optional<LandmarkFormat> landmark_format(Format format) {
    if (format < Format::landmarks_csv || format > Format::fcsv) return {};
    return static_cast<LandmarkFormat>(static_cast<int>(format) - static_cast<int>(Format::landmarks_csv));
}

/// Adds imported annotations to a set; an id that is in use is replaced.
PlacedAnnotations added_to(const AnnotationSet& existing, PlacedAnnotations imported) {
    PlacedAnnotations result;
    result.placements = std::move(imported.placements);
    result.set = existing;
    result.set.provenance.SetNull();
    if (existing.object_class.empty()) result.set.object_class = imported.set.object_class;
    if (existing.unit.empty()) result.set.unit = imported.set.unit;
    if (!existing.up) result.set.up = imported.set.up;
    result.set.notes.insert(result.set.notes.end(), imported.set.notes.begin(), imported.set.notes.end());
    if (!existing.unit.empty() && !imported.set.unit.empty() && existing.unit != imported.set.unit)
        result.set.notes.push_back(fmt::format("the file is in {}, the annotations in {}; coordinates were not converted",
                                               imported.set.unit, existing.unit));
    std::set<int> used_ids, imported_ids;
    for (const Annotation& annotation : existing.annotations) used_ids.insert(annotation.id);
    for (const Annotation& annotation : imported.set.annotations) imported_ids.insert(annotation.id);
    int next_id = 0;
    std::map<int, int> renamed;
    for (Annotation& annotation : imported.set.annotations) {
        const int old_id = annotation.id;
        if (used_ids.contains(old_id)) {
            while (used_ids.contains(next_id) || imported_ids.contains(next_id)) ++next_id;
            annotation.id = next_id++;
            renamed[old_id] = annotation.id;
            result.set.notes.push_back(
                fmt::format("the id {} is in use: '{}' of the file received the id {}", old_id, annotation.tag, annotation.id));
        }
        result.set.annotations.push_back(std::move(annotation));
    }
    for (PlacedAnnotation& placement : result.placements)
        if (const auto renaming = renamed.find(placement.id); renaming != renamed.end()) placement.id = renaming->second;
    return result;
}

}  // namespace

const std::vector<std::string>& interchange_formats() {
    static const std::vector<std::string> names{"attributes-csv", "landmarks-csv", "tps", "pp",  "mrk",
                                                "fcsv",           "web",           "glb", "ant", "fct"};
    return names;
}

std::string guess_interchange_format(const Path& file, const std::string& bytes) {
    const std::string ending = extension(file);
    if (ending == ".csv") return bytes.empty() || is_attribute_table(bytes) ? "attributes-csv" : "landmarks-csv";
    if (ending == ".tps") return "tps";
    if (ending == ".pp") return "pp";
    if (ending == ".fcsv") return "fcsv";
    if (ending == ".json" && extension(file.stem()) == ".mrk") return "mrk";
    if (ending == ".jsonld") return "web";
    // Manifests and annotation pages of IIIF usually end in .json.
    if (ending == ".json" && bytes.find("\"type\"") != std::string::npos &&
        (bytes.find("iiif.io/api/presentation") != std::string::npos || bytes.find("www.w3.org/ns/anno") != std::string::npos))
        return "web";
    if (ending == ".glb" || ending == ".ant" || ending == ".fct") return ending.substr(1);
    fail_usage(fmt::format("the extension of '{}' does not determine a format", file.filename().string()),
               "specify it with --format");
}

ExportedAnnotations export_annotations(AnnotatedMeshView object, const std::string& format_name, const std::string& mesh_file,
                                       const Provenance& provenance, const ExportOptions& options) {
    check_options(options, "annotation export");
    check_annotations(object, mesh_file.empty() ? "annotations" : "annotations of " + mesh_file);
    ExportedAnnotations result;
    const auto count = [&](auto&& predicate) {
        return static_cast<std::size_t>(
            std::count_if(object.annotations.annotations.begin(), object.annotations.annotations.end(), predicate));
    };
    result.annotations = object.annotations.annotations.size();
    const Format format = format_named(format_name);
    if (const auto landmarks = landmark_format(format)) {
        const LandmarkSet exported = landmarks_of(object, *landmarks);
        result.notes = exported.notes;
        result.annotations = count([&](const Annotation& annotation) {
            return annotation.type == AnnotationType::point ||
                   (annotation.type == AnnotationType::line && *landmarks == LandmarkFormat::mrk);
        });
        result.bytes = landmarks_to_text(exported, *landmarks, mesh_file, provenance, result.notes, options.landmarks);
    } else if (format == Format::attributes_csv) {
        result.bytes = attribute_table(object.annotations);
    } else if (format == Format::web) {
        result.bytes = web_annotations(object, mesh_file, provenance);
    } else if (format == Format::glb) {
        result.bytes = feature_glb(object, mesh_file, provenance, result.notes);
    } else if (format == Format::ant) {
        result.bytes = prototype_annotations(object, result.notes);
    } else if (format == Format::fct) {
        result.annotations = count(has_facet);
        result.bytes = prototype_facets(object, mesh_file, result.notes);
    }
    return result;
}

PlacedAnnotations import_annotations(const Mesh& mesh, const std::string& bytes, const std::string& format_name,
                                     const std::string& where, const AnnotationSet* onto, const ImportOptions& options) {
    check_options(options, "annotation import");
    if (bytes.find_first_not_of(" \t\r\n") == std::string::npos) fail_input(where, "is empty", "give a file with annotations");
    PlacedAnnotations result;
    const Format format = format_named(format_name);
    if (const auto landmarks = landmark_format(format)) {
        const LandmarkSet landmark_set = landmarks_from_text(bytes, *landmarks, where, options.landmarks);
        if (landmark_set.landmarks.empty() && landmark_set.curves.empty())
            fail_input(where, "contains no landmarks" + (landmark_set.notes.empty() ? "" : ": " + landmark_set.notes.back()),
                       "give a file with points, or the right --format");
        result = place_landmarks(mesh, landmark_set, where, options.place);
    } else if (format == Format::attributes_csv) {
        if (onto == nullptr)
            fail_usage("a table of attributes contains no selections",
                       "give the annotations from which it was exported with --onto FILE");
        result.set = *onto;
        result.set.provenance.SetNull();
        const std::size_t changed = apply_attribute_table(bytes, result.set, where);
        result.set.notes.push_back(counted(changed, "annotation") + " updated from the table");
    } else if (format == Format::web) {
        result = read_web_annotations(bytes, mesh, where, options.place);
    } else if (format == Format::glb) {
        result = read_feature_glb(bytes, mesh, where, options.place);
    } else if (format == Format::ant) {
        result.set = annotations_from_json(parse_json(bytes, where), mesh, where);
    } else if (format == Format::fct) {
        result.set = read_prototype_facets(bytes, mesh, where);
    }
    if (onto != nullptr && format != Format::attributes_csv) result = added_to(*onto, std::move(result));
    check_annotations({mesh, result.set}, where);
    return result;
}

void ExportOptions::declare_options(OptionList& list) { landmarks.declare_options(list); }

void ImportOptions::declare_options(OptionList& list) {
    landmarks.declare_options(list);
    place.declare_options(list);
}

}  // namespace ostraka
