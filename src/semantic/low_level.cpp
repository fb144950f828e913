// Constraints of the solver, stated by their own names (thesis, section 4.2), on the vertices of annotations.
#include "ostraka/core/angles.h"
#include "reader.h"

#include <set>

namespace ostraka::semantic {

namespace {

/// How the vertices of the annotations are grouped into constraints.
enum class Groups { together, pairs, members, edges, faces, hinges, stars };

/// Whether the admissible set depends on the shape at rest.
enum class Keeps { nothing, rest, rest_without_absolute };

struct Form {
    const char* kind;
    Groups groups;
    Keeps keeps = Keeps::nothing;
};

/// The kinds whose parameters can be given by annotations. The others are created from their own types of relationship.
const std::vector<Form>& forms() {
    static const std::vector<Form> list{
        {"Closeness", Groups::together, Keeps::rest},
        {"Line", Groups::together},
        {"Plane", Groups::together},
        {"Orientation", Groups::together},
        {"FittedPlaneOrientation", Groups::together},
        {"Circle", Groups::together},
        {"Sphere", Groups::together},
        {"Similarity", Groups::members, Keeps::rest},
        {"Rigid", Groups::members, Keeps::rest},
        {"NonUniformScaling", Groups::members, Keeps::rest},
        {"Equilateral", Groups::together},
        {"Parallelogram", Groups::together},
        {"Rectangle", Groups::together},
        {"Angle", Groups::together},
        {"Parallel", Groups::pairs},
        {"Perpendicular", Groups::together},
        {"PolylineLength", Groups::members, Keeps::rest_without_absolute},
        {"EqualLengths", Groups::pairs},
        {"CoAxiality", Groups::members},
        {"TetrahedronStrain", Groups::together, Keeps::rest},
        {"Volume", Groups::together, Keeps::rest_without_absolute},
        {"EdgeStrain", Groups::edges, Keeps::rest_without_absolute},
        {"TriangleStrain", Groups::faces, Keeps::rest},
        {"Area", Groups::faces, Keeps::rest_without_absolute},
        {"Bending", Groups::hinges, Keeps::rest_without_absolute},
        {"Laplacian", Groups::stars},
        {"LaplacianDisplacement", Groups::stars, Keeps::rest},
        {"CotangentLaplacian", Groups::stars},
        {"CotangentLaplacianDisplacement", Groups::stars, Keeps::rest},
    };
    return list;
}

std::string plain(std::string_view name) {
    std::string text;
    for (const char c : name)
        if (c != ' ' && c != '-') text += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return text;
}

const Form* form_of(const std::string& type) {
    for (const Form& form : forms())
        if (plain(form.kind) == plain(type)) return &form;
    return nullptr;
}

/// Vertices of an annotation in its order: points as given, along polylines, otherwise ascending.
std::vector<int> in_order(const Mesh& mesh, const Annotation& annotation) {
    std::vector<int> ids;
    if (annotation.type == AnnotationType::point) return {annotation.points.begin(), annotation.points.end()};
    if (annotation.type == AnnotationType::line) {
        for (const auto& line : annotation.polylines) ids.insert(ids.end(), line.begin(), line.end());
        return ids;
    }
    const auto vertices = vertices_of(mesh, annotation);
    return {vertices.begin(), vertices.end()};
}

void add_edges(const Mesh& mesh, const Annotation& annotation, std::vector<std::vector<int>>& groups) {
    if (annotation.type != AnnotationType::region) {
        const std::vector<int> ids = in_order(mesh, annotation);
        for (std::size_t i = 1; i < ids.size(); ++i) groups.push_back({ids[i - 1], ids[i]});
        return;
    }
    std::set<std::array<int, 2>> edges;
    for (const Index f : annotation.faces) {
        const auto corner = corners(mesh, Face(f));
        for (std::size_t k = 0; k < 3; ++k) {
            const Index a = corner[k], b = corner[(k + 1) % 3];
            edges.insert({static_cast<int>(std::min(a, b)), static_cast<int>(std::max(a, b))});
        }
    }
    for (const auto& [a, b] : edges) groups.push_back({a, b});
}

void add_hinges(const Mesh& mesh, const Annotation& annotation, std::vector<std::vector<int>>& groups) {
    const std::vector<bool> inside = face_flags(mesh, annotation.faces);
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e), o = mesh.opposite(h);
        if (mesh.is_border(h) || mesh.is_border(o) || !inside[mesh.face(h)] || !inside[mesh.face(o)]) continue;
        const auto id = [&](Vertex v) { return static_cast<int>(v.idx()); };
        groups.push_back({id(mesh.source(h)), id(mesh.target(h)), id(mesh.target(mesh.next(h))), id(mesh.target(mesh.next(o)))});
    }
}

std::vector<std::vector<int>> groups_of(const Reader& read, const Form& form) {
    const Mesh& mesh = read.shape().mesh;
    std::vector<std::vector<int>> groups;
    std::set<int> seen;
    for (std::size_t i = 0; i < read.members(); ++i) {
        const Annotation& annotation = read.member(i);
        if (vertices_of(mesh, annotation).empty())
            read.fail("annotation " + std::to_string(annotation.id) + " selects nothing", "select a part, or leave it out");
        if (form.groups == Groups::faces || form.groups == Groups::hinges) read.need_region(i);
        switch (form.groups) {
            case Groups::pairs:
            case Groups::together:
                if (groups.empty()) groups.emplace_back();
                for (const int v : in_order(mesh, annotation))
                    if (form.groups == Groups::pairs || seen.insert(v).second) groups[0].push_back(v);
                break;
            case Groups::members:
                groups.push_back(in_order(mesh, annotation));
                break;
            case Groups::edges:
                add_edges(mesh, annotation, groups);
                break;
            case Groups::faces:
                for (const Index f : annotation.faces) {
                    const auto corner = corners(mesh, Face(f));
                    groups.push_back({static_cast<int>(corner[0]), static_cast<int>(corner[1]), static_cast<int>(corner[2])});
                }
                break;
            case Groups::hinges:
                add_hinges(mesh, annotation, groups);
                break;
            case Groups::stars:
                // Cotangent weights need the complete one-ring.
                for (const Index v : vertices_of(mesh, annotation))
                    if (std::string_view(form.kind).find("Cotangent") == std::string_view::npos || !mesh.is_border(Vertex(v)))
                        groups.push_back(star_of(mesh, Vertex(v)));
                break;
        }
    }
    if (groups.empty()) read.fail("has nothing to act on", "give larger regions");
    return groups;
}

}  // namespace

const ConstraintKind* low_level_kind(const std::string& type) {
    if (form_of(type) == nullptr) return nullptr;
    for (const ConstraintKind& kind : constraint_kinds())
        if (plain(kind.name) == plain(type)) return &kind;
    return nullptr;
}

Statement low_level(const ReaderPtr& read, const RelationOptions& tolerances) {
    const Form& form = *form_of(read->relationship().type);
    const auto groups = std::make_shared<const std::vector<std::vector<int>>>(groups_of(*read, form));
    const bool degrees = std::string_view(form.kind) == "Angle";
    ConstraintParameters parameters;
    if (read->has("minValue")) parameters.min = read->number("minValue", 0, 0, 1e60) * (degrees ? degree : 1);
    if (read->has("maxValue")) parameters.max = read->number("maxValue", 0, 0, 1e60) * (degrees ? degree : 1);
    parameters.absolute = read->flag("absolute");
    parameters.direction = read->direction("direction");
    parameters.point = read->vector("point");
    const auto lower = [=] {
        Statement::Constraints list;
        for (const auto& ids : *groups) list.push_back(read->make(form.kind, ids, parameters));
        return list;
    };
    Statement statement;
    statement.resizes = true;
    if (form.keeps == Keeps::rest || (form.keeps == Keeps::rest_without_absolute && !parameters.absolute))
        statement.keeps = "what its vertices are to each other";
    statement.lower = [lower](const State&, const State&) { return lower(); };
    const auto list = std::make_shared<const Statement::Constraints>(lower());
    // Residuals are relative to the size of the group at rest, since edges and faces are smaller on finer meshes.
    std::vector<double> sizes;
    for (const auto& constraint : *list) sizes.push_back(read->size_at_rest(*constraint));
    const Deviation residual{"residual of a vertex", 0.0, 100 * tolerances.distance, "%"};
    statement.measure = [=](const State& deformed) {
        Deviation worst = residual;
        for (std::size_t i = 0; i < list->size(); ++i)
            if (sizes[i] > 0)
                worst.value = std::max(*worst.value, 100 * (*list)[i]->normalised_residual(deformed.points) / sizes[i]);
        return verdict_of({worst});
    };
    return statement;
}

}  // namespace ostraka::semantic
