// Constraints of the solver, stated by their own names (thesis, section 4.2), on the vertices of annotations.
#include "ostraka/core/angles.h"
#include "semantic/statements.h"

#include <set>

namespace ostraka::semantic {

namespace {

/// How the vertices of the annotations are grouped into constraints.
enum class Groups { together, pairs, members, edges, faces, hinges, stars, closed_stars };

/// Whether the admissible set depends on the shape at rest.
enum class Keeps { nothing, rest, rest_without_absolute };

/// Parameters of the solver's kinds as files give them.
struct Parameters {
    std::optional<double> min, max;
    bool absolute;
    std::optional<Vector3d> direction, point;

    explicit Parameters(const ParameterReader& read)
        : min(read.number("minValue", 0, 1e60)),
          max(read.number("maxValue", 0, 1e60)),
          absolute(read.flag("absolute")),
          direction(read.direction("direction")),
          point(read.vector("point")),
          read_(read) {}
    [[nodiscard]] Interval range(double default_min, double default_max) const {
        return {min.value_or(default_min), max.value_or(default_max)};
    }
    /// A range relative to the value at rest, or absolute.
    [[nodiscard]] Interval range_of_measure() const {
        if (absolute && !min && !max) read_.fail("the absolute range is missing", "");
        return absolute ? range(0, kinds::infinity) : range(1, 1);
    }
    [[nodiscard]] Interval stretch() const {
        if (absolute) read_.fail("strain has no absolute range", "");
        return range(1, 1);
    }
    [[nodiscard]] Vector3d need_direction() const {
        if (!direction) read_.fail("the direction is missing", "");
        return *direction;
    }
    [[nodiscard]] Vector3d need_point() const {
        if (!point) read_.fail("the point is missing", "");
        return *point;
    }

private:
    const ParameterReader& read_;
};

struct Form {
    const char* type;
    Groups groups;
    Keeps keeps;
    ConstraintKind (*kind)(const Parameters&);
};

template <class Kind>
ConstraintKind without_parameters(const Parameters&) {
    return Kind{};
}
template <class Kind>
ConstraintKind of_direction(const Parameters& p) {
    return Kind{p.need_direction()};
}
template <class Kind>
ConstraintKind of_measure(const Parameters& p) {
    return Kind{p.range_of_measure(), p.absolute};
}
template <class Kind>
ConstraintKind of_stretch(const Parameters& p) {
    return Kind{p.stretch()};
}

/// The kinds whose parameters can be given by annotations, by the name of their type. The others are created from their own types
/// of relationship.
const std::vector<Form>& forms() {
    using namespace kinds;
    constexpr auto rest = Keeps::rest, relative = Keeps::rest_without_absolute, nothing = Keeps::nothing;
    static const std::vector<Form> list{
        {"closeness", Groups::together, rest, without_parameters<Closeness>},
        {"line", Groups::together, nothing, without_parameters<kinds::Line>},
        {"plane", Groups::together, nothing, without_parameters<kinds::Plane>},
        {"orientation", Groups::together, nothing, of_direction<Orientation>},
        {"fitted-plane orientation", Groups::together, nothing, of_direction<FittedPlaneOrientation>},
        {"circle", Groups::together, nothing, without_parameters<Circle>},
        {"sphere", Groups::together, nothing, without_parameters<Sphere>},
        {"similarity", Groups::members, rest,
         [](const Parameters& p) -> ConstraintKind { return Similarity{p.range(0, infinity)}; }},
        {"rigid", Groups::members, rest, without_parameters<Rigid>},
        {"non-uniform scaling", Groups::members, rest,
         [](const Parameters& p) -> ConstraintKind {
             return NonUniformScaling{p.need_direction(), p.range(0, infinity)};
         }},
        {"equilateral", Groups::together, nothing, without_parameters<Equilateral>},
        {"parallelogram", Groups::together, nothing, without_parameters<Parallelogram>},
        {"rectangle", Groups::together, nothing, without_parameters<Rectangle>},
        {"angle", Groups::together, nothing,
         [](const Parameters& p) -> ConstraintKind {
             return Angle{{p.min.value_or(0) * degree, p.max ? *p.max * degree : pi}};
         }},
        {"parallel", Groups::pairs, nothing, without_parameters<Parallel>},
        {"perpendicular", Groups::together, nothing, without_parameters<Perpendicular>},
        {"polyline length", Groups::members, relative, of_measure<PolylineLength>},
        {"equal lengths", Groups::pairs, nothing, without_parameters<EqualLengths>},
        {"co-axiality", Groups::members, nothing,
         [](const Parameters& p) -> ConstraintKind {
             return CoAxiality{p.need_direction(), p.need_point()};
         }},
        {"tetrahedron strain", Groups::together, rest, of_stretch<TetrahedronStrain>},
        {"volume", Groups::together, relative, of_measure<Volume>},
        {"edge strain", Groups::edges, relative, of_measure<EdgeStrain>},
        {"triangle strain", Groups::faces, rest, of_stretch<TriangleStrain>},
        {"area", Groups::faces, relative, of_measure<Area>},
        {"bending", Groups::hinges, relative, of_measure<Bending>},
        {"laplacian", Groups::stars, nothing, without_parameters<Laplacian>},
        {"laplacian displacement", Groups::stars, rest, without_parameters<LaplacianDisplacement>},
        {"cotangent laplacian", Groups::closed_stars, nothing, without_parameters<CotangentLaplacian>},
        {"cotangent laplacian displacement", Groups::closed_stars, rest, without_parameters<CotangentLaplacianDisplacement>},
    };
    return list;
}

/// The letters of a name: "Edge strain" and "EdgeStrain" are the same.
std::string letters_of(std::string_view name) {
    std::string text;
    for (const char c : name)
        if (c != ' ' && c != '-') text += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return text;
}

const Form* form_of(const std::string& type) {
    for (const Form& form : forms())
        if (letters_of(form.type) == letters_of(type)) return &form;
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

std::vector<std::vector<int>> groups_of(const ConstraintMembers& members, const Form& form) {
    const Mesh& mesh = members.shape().mesh;
    std::vector<std::vector<int>> groups;
    std::set<int> seen;
    for (std::size_t i = 0; i < members.count(); ++i) {
        const Annotation& annotation = members.member(i);
        if (vertices_of(mesh, annotation).empty())
            members.fail("annotation " + std::to_string(annotation.id) + " selects nothing", "select a part, or leave it out");
        if (form.groups == Groups::faces || form.groups == Groups::hinges) members.need_region(i);
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
            case Groups::closed_stars:  // cotangent weights need the complete one-ring
                for (const Index v : vertices_of(mesh, annotation))
                    if (form.groups == Groups::stars || !mesh.is_border(Vertex(v)))
                        groups.push_back(vertex_star(mesh, Vertex(v)));
                break;
        }
    }
    if (groups.empty()) members.fail("has nothing to act on", "give larger regions");
    return groups;
}

}  // namespace

int length_power(const std::string& type) {
    if (!is_low_level(type)) return 0;
    const std::string name = letters_of(type);
    if (name == "polylinelength" || name == "edgestrain" || name == "bending") return 1;
    return name == "area" ? 2 : name == "volume" ? 3 : 0;
}

bool is_low_level(const std::string& type) { return form_of(type) != nullptr; }

Statement low_level(const MembersPtr& members, const ParameterReader& read, const RelationOptions& tolerances) {
    const Form& form = *form_of(members->relationship().type);
    const auto groups = std::make_shared<const std::vector<std::vector<int>>>(groups_of(*members, form));
    const Parameters parameters(read);
    const ConstraintKind kind = form.kind(parameters);
    const auto lower = [=] {
        Statement::Constraints list;
        for (const auto& ids : *groups) list.push_back(members->make(kind, ids));
        return list;
    };
    Statement statement;
    statement.resizes = true;
    if (form.keeps == Keeps::rest || (form.keeps == Keeps::rest_without_absolute && !parameters.absolute))
        statement.keeps = "the relative positions of its vertices";
    statement.lower = [lower](const State&, const State&) { return lower(); };
    const auto list = std::make_shared<const Statement::Constraints>(lower());
    // Residuals are relative to the size of the group at rest, since edges and faces are smaller on finer meshes.
    std::vector<double> sizes;
    for (const auto& constraint : *list) sizes.push_back(members->size_at_rest(*constraint));
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
