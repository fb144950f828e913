// publish: an annotated object as a static web folder: IIIF manifest, GLB with features, annotations, a page.
#include "operations/annotated_scene.h"
#include "operations/operations.h"
#include "operations/scene_colours.h"

#include "ostraka/annotation/cut_extras.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/interchange/feature_glb.h"
#include "ostraka/interchange/web_annotation.h"
#include "ostraka/io/glb.h"
#include "ostraka/page/page.h"

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <algorithm>

namespace ostraka {

namespace {

/// Maps points of the mesh to positions in a viewer of the GLB, whose node rotates and scales the mesh.
class ViewerTransform {
public:
    explicit ViewerTransform(const std::string& file) {
        const glb::Reader reader(file, "model.glb");
        for (const JsonValue& node : list_in(reader.document(), "nodes")) {
            const auto rotation = list_in(node, "rotation");
            if (rotation.Size() == 4)
                rotation_ = Eigen::Quaterniond(rotation[3].GetDouble(), rotation[0].GetDouble(), rotation[1].GetDouble(),
                                               rotation[2].GetDouble());
            if (const auto scale = list_in(node, "scale"); scale.Size() == 3) scale_ = scale[0].GetDouble();
        }
    }
    [[nodiscard]] Eigen::Vector3d operator()(const Point& p) const {
        return scale_ * (rotation_ * Eigen::Vector3d(p.x(), p.y(), p.z()));
    }

private:
    Eigen::Quaterniond rotation_{1, 0, 0, 0};
    double scale_ = 1;
};

/// A position on the annotation: for a region the centroid of the face nearest to its centre, for a line its middle vertex.
std::optional<Point> label_position(const Mesh& mesh, const Annotation& annotation) {
    if (!annotation.points.empty()) return mesh.point(Vertex(annotation.points.front()));
    if (!annotation.polylines.empty() && !annotation.polylines.front().empty()) {
        const auto& line = annotation.polylines.front();
        return mesh.point(Vertex(line[line.size() / 2]));
    }
    if (annotation.faces.empty()) return std::nullopt;
    const auto centroid = [&](Index face) {
        const auto [a, b, c] = corners(mesh, Face(face));
        return CGAL::centroid(mesh.point(a), mesh.point(b), mesh.point(c));
    };
    Vector sum(0, 0, 0);
    for (const Index face : annotation.faces) sum = sum + (centroid(face) - CGAL::ORIGIN);
    const Point middle = CGAL::ORIGIN + sum / static_cast<double>(annotation.faces.size());
    return centroid(*std::min_element(annotation.faces.begin(), annotation.faces.end(), [&](Index a, Index b) {
        return CGAL::squared_distance(centroid(a), middle) < CGAL::squared_distance(centroid(b), middle);
    }));
}

struct Publish final : AnnotatedMeshOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        p.output("folder", Kind::folder, folder, "folder to write; created if missing");
        p.options("address", address, "web address at which the folder will be served, such as https://museum.example/pot");
        p.options("title", title, "title of the object; by default the name of the mesh");
        p.options("colour", colouring, page_colouring_help, page_colouring_names());
        p.options("rights", rights, "web address of the licence, such as http://creativecommons.org/licenses/by/4.0/");
        p.options("credit", credit, "attribution statement that a viewer must show");
        p.report.values(text("manifest"), integer("annotations", "annotations"));
    }

    void check() const override {
        for (const auto& [name, value, required] : {std::tuple("address", address, true), std::tuple("rights", rights, false)}) {
            const bool valid = (value.starts_with("https://") || value.starts_with("http://")) &&
                               value.find_first_of(" <>\"\\^`{|}#?\x7f") == std::string::npos && value.size() > 8 &&
                               std::all_of(value.begin(), value.end(), [](unsigned char c) { return c >= 32; });
            if (!valid && (required || !value.empty()))
                fail_usage(fmt::format("--{} '{}' is not a web address", name, value),
                           "give one that begins with https:// and has neither blanks nor # and ?");
        }
    }

    void run(Context& context, Report& report) override {
        const AnnotatedMeshView subject = object();
        const std::string name = title.empty() ? Path(mesh.file_name()).stem().string() : title;
        folder.open();
        std::vector<std::string> notes;
        const MeshExtras& extras = mesh->extras;
        const std::string model = feature_glb(subject, mesh.file(), context.provenance(), notes, extras);
        report.notes(notes);
        write_file(folder.in("model.glb"), model);
        write_file(folder.in("annotations.jsonld"), web_annotations(subject, mesh.file(), context.provenance()));
        write_png(folder.in("thumbnail.png"), thumbnail(subject.mesh, &subject.annotations, extras, "400x300"));
        Page page(name);
        PageObject page_object;
        page_object.name = name;
        const EdgeAlignedAnnotations along_edges(subject);  // free outlines are shown on the mesh cut along them
        page_object.mesh = &along_edges.object().mesh;
        page_object.annotations = &along_edges.object().annotations;
        MeshExtras extras_of_cut;
        if (along_edges.cut()) extras_of_cut = cut_extras(*along_edges.cut(), subject.mesh, extras);
        page_object.extras = along_edges.cut() ? &extras_of_cut : &extras;
        page_object.colouring = page_colouring(colouring);
        page.add(page_object);
        if (!subject.annotations.annotations.empty()) page.add(annotation_table(subject, 0, name));
        write_file(folder.in("index.html"), page.html(context.provenance().to_line()));
        std::size_t placed = 0;
        const Json document = manifest(subject, name, ViewerTransform(model), placed);
        write_json(folder.in("manifest.json"), document);
        report("manifest", url("manifest.json"))("annotations", placed);
    }

    [[nodiscard]] std::string url(const std::string& place) const {
        return address + (address.ends_with('/') ? "" : "/") + place;
    }

    /// IIIF Presentation API 4: one Scene with the GLB painted into it, and one comment at a position of each annotation.
    Json manifest(AnnotatedMeshView object, const std::string& name, const ViewerTransform& to_viewer,
                  std::size_t& placed) const {
        Json document;
        document.SetObject();
        auto& a = document.GetAllocator();
        const auto words = [&](const std::string& text) {
            return json_object(a, "none", json_list_of(json_string(printable(text, 2000), a), a));
        };
        const auto list_of_one = [&](JsonValue value) { return json_list_of(std::move(value), a); };
        const std::string scene = url("scene");
        const auto scene_reference = [&] { return json_object(a, "id", scene, "type", "Scene"); };
        JsonValue comments(rapidjson::kArrayType);
        for (const Annotation& annotation : object.annotations.annotations) {
            const auto position = label_position(object.mesh, annotation);
            if (!position) continue;
            const Eigen::Vector3d p = to_viewer(*position);
            std::string text = annotation.tag.empty() ? "annotation " + std::to_string(annotation.id) : annotation.tag;
            if (!annotation.note.empty()) text += ": " + annotation.note;
            for (const Attribute& attribute : annotation.attributes)
                if (const Measure* measure = attribute.measure(); measure != nullptr && measure->value)
                    text += fmt::format("; {} {}{}", attribute.name, digits(*measure->value, 5),
                                        measure->unit.empty() ? "" : " " + measure->unit);
            JsonValue selector = json_object(a, "type", "PointSelector", "x", p.x(), "y", p.y(), "z", p.z());
            JsonValue target =
                json_object(a, "id", url(fmt::format("annotation/{}/target", annotation.id)), "type", "SpecificResource",
                            "source", scene_reference(), "selector", list_of_one(std::move(selector)));
            JsonValue body = json_object(a, "type", "TextualBody", "value", printable(text, 2000), "format", "text/plain");
            comments.PushBack(
                json_object(a, "id", url("annotation/" + std::to_string(annotation.id)), "type", "Annotation", "motivation",
                            std::array{"commenting"}, "body", std::move(body), "target", std::move(target)),
                a);
            ++placed;
        }
        JsonValue model = json_object(a, "id", url("model.glb"), "type", "Model", "format", "model/gltf-binary");
        JsonValue painting = json_object(a, "id", url("painting/1"), "type", "Annotation", "motivation", std::array{"painting"},
                                         "body", std::move(model), "target", scene_reference());
        JsonValue painted =
            json_object(a, "id", url("painting"), "type", "AnnotationPage", "items", list_of_one(std::move(painting)));
        JsonValue scene_item =
            json_object(a, "id", scene, "type", "Scene", "label", words(name), "items", list_of_one(std::move(painted)));
        if (!comments.Empty())
            add_members(
                scene_item, a, "annotations",
                list_of_one(json_object(a, "id", url("comments"), "type", "AnnotationPage", "items", std::move(comments))));
        add_members(document, a, "@context", "http://iiif.io/api/presentation/4/context.json", "id", url("manifest.json"), "type",
                    "Manifest", "label", words(name));
        if (!rights.empty()) add_members(document, a, "rights", rights);
        if (!credit.empty())
            add_members(document, a, "requiredStatement", json_object(a, "label", words("credit"), "value", words(credit)));
        add_members(
            document, a, "thumbnail",
            list_of_one(
                json_object(a, "id", url("thumbnail.png"), "type", "Image", "format", "image/png", "width", 400, "height", 300)),
            "rendering",
            list_of_one(json_object(a, "id", url("index.html"), "type", "Text", "label", words(name), "format", "text/html")),
            "seeAlso",
            list_of_one(json_object(a, "id", url("annotations.jsonld"), "type", "Dataset", "format", "application/ld+json",
                                    "profile", "http://www.w3.org/ns/anno.jsonld", "label", words("annotations"))),
            "items", list_of_one(std::move(scene_item)));
        return document;
    }

    FolderOutput folder;
    std::string address, title, rights, credit;
    PageColouring colouring = PageColouring::automatic;
};

}  // namespace

std::unique_ptr<Operation> make_publish() { return make<Publish>(); }

}  // namespace ostraka
