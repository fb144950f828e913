#include "ostraka/interchange/interchange.h"

#include "landmark_formats.h"

#include "ostraka/core/error.h"
#include "ostraka/core/words.h"
#include "ostraka/interchange/attribute_table.h"
#include "ostraka/interchange/feature_glb.h"
#include "ostraka/interchange/prototype_files.h"
#include "ostraka/interchange/web_annotation.h"

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

namespace {

/// In the order of interchange_formats(); the landmark formats are in the order of LandmarkFormat.
enum class Format { attributes_csv, landmarks_csv, tps, pp, mrk, fcsv, web, glb, ant, fct };

Format format_named(const std::string& name) {
    const auto& names = interchange_formats();
    if (const auto found = std::find(names.begin(), names.end(), name); found != names.end())
        return static_cast<Format>(found - names.begin());
    fail_usage("the format '" + name + "' is not known", "use one of: " + joined(names));
}

std::optional<LandmarkFormat> landmark_format(Format format) {
    if (format < Format::landmarks_csv || format > Format::fcsv) return {};
    return static_cast<LandmarkFormat>(static_cast<int>(format) - static_cast<int>(Format::landmarks_csv));
}

/// Adds imported annotations to a set; an id that is in use is replaced.
PlacedAnnotations added_to(const AnnotationSet& onto, PlacedAnnotations read) {
    PlacedAnnotations result;
    result.placements = std::move(read.placements);
    result.set = onto;
    result.set.provenance.SetNull();
    if (onto.object_class.empty()) result.set.object_class = read.set.object_class;
    if (onto.unit.empty()) result.set.unit = read.set.unit;
    if (!onto.up) result.set.up = read.set.up;
    result.set.notes.insert(result.set.notes.end(), read.set.notes.begin(), read.set.notes.end());
    if (!onto.unit.empty() && !read.set.unit.empty() && onto.unit != read.set.unit)
        result.set.notes.push_back("the file is in " + read.set.unit + ", the annotations in " + onto.unit +
                                   "; coordinates were taken as they stand");
    std::set<int> taken, reserved;
    for (const Annotation& annotation : onto.annotations) taken.insert(annotation.id);
    for (const Annotation& annotation : read.set.annotations) reserved.insert(annotation.id);
    int fresh = 0;
    std::map<int, int> renamed;
    for (Annotation& annotation : read.set.annotations) {
        const int before = annotation.id;
        if (taken.contains(before)) {
            while (taken.contains(fresh) || reserved.contains(fresh)) ++fresh;
            annotation.id = fresh++;
            renamed[before] = annotation.id;
            result.set.notes.push_back("the id " + std::to_string(before) + " is taken: '" + annotation.tag +
                                       "' of the file got " + std::to_string(annotation.id));
        }
        result.set.annotations.push_back(std::move(annotation));
    }
    for (PlacedAnnotation& placement : result.placements)
        if (const auto found = renamed.find(placement.id); found != renamed.end()) placement.id = found->second;
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
    if (ending == ".glb" || ending == ".ant" || ending == ".fct") return ending.substr(1);
    fail_usage("the ending of '" + file.filename().string() + "' tells no format", "say it with --format");
}

ExportedAnnotations export_annotations(const Mesh& mesh, const AnnotationSet& set, const std::string& named,
                                       const std::string& mesh_file, const Provenance& provenance, const ExportOptions& options) {
    check_options(options, "annotation export");
    check_annotations(set, mesh, mesh_file.empty() ? "annotations" : "annotations of " + mesh_file);
    ExportedAnnotations result;
    const auto count = [&](auto&& written) {
        return static_cast<std::size_t>(std::count_if(set.annotations.begin(), set.annotations.end(), written));
    };
    result.annotations = set.annotations.size();
    const Format format = format_named(named);
    if (const auto landmarks = landmark_format(format)) {
        const LandmarkSet places = landmarks_of(mesh, set, *landmarks);
        result.notes = places.notes;
        result.annotations = count([&](const Annotation& annotation) {
            return annotation.type == AnnotationType::point ||
                   (annotation.type == AnnotationType::line && *landmarks == LandmarkFormat::mrk);
        });
        result.bytes = landmarks_to_text(places, *landmarks, mesh_file, provenance, result.notes, options.landmarks);
    } else if (format == Format::attributes_csv) {
        result.bytes = attribute_table(set);
    } else if (format == Format::web) {
        result.bytes = web_annotations(mesh, set, mesh_file, provenance);
    } else if (format == Format::glb) {
        result.bytes = feature_glb(mesh, set, mesh_file, provenance, result.notes);
    } else if (format == Format::ant) {
        result.bytes = prototype_annotations(mesh, set, result.notes);
    } else if (format == Format::fct) {
        result.annotations = count(has_facet);
        result.bytes = prototype_facets(mesh, set, mesh_file, result.notes);
    }
    return result;
}

PlacedAnnotations import_annotations(const Mesh& mesh, const std::string& bytes, const std::string& named,
                                     const std::string& where, const AnnotationSet* onto, const ImportOptions& options) {
    check_options(options, "annotation import");
    if (bytes.find_first_not_of(" \t\r\n") == std::string::npos)
        fail_input(where, "is empty", "give a file that holds annotations");
    PlacedAnnotations result;
    const Format format = format_named(named);
    if (const auto landmarks = landmark_format(format)) {
        const LandmarkSet read = landmarks_from_text(bytes, *landmarks, where, options.landmarks);
        if (read.landmarks.empty() && read.curves.empty())
            fail_input(where, "holds no landmarks" + (read.notes.empty() ? "" : ": " + read.notes.back()),
                       "give a file with places, or the right --format");
        result = place_landmarks(mesh, read, where, options.place);
    } else if (format == Format::attributes_csv) {
        if (onto == nullptr)
            fail_usage("a table of attributes holds no selections", "give the annotations it was made of with --onto FILE");
        result.set = *onto;
        result.set.provenance.SetNull();
        const std::size_t changed = apply_attribute_table(bytes, result.set, where);
        result.set.notes.push_back(counted(changed, "annotation") + " of the table taken over");
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
    check_annotations(result.set, mesh, where);
    return result;
}

void ExportOptions::describe(OptionList& visit) { landmarks.describe(visit); }

void ImportOptions::describe(OptionList& visit) {
    landmarks.describe(visit);
    place.describe(visit);
}

}  // namespace ostraka
