// Fits templates to other members of their class with known correspondence: errors of the vertices for each rule of finding
// their counterparts.
#include "harness.h"
#include "scenes.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/synthetic/fragments.h"
#include "ostraka/synthetic/make_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

struct CounterpartOptions {
    std::string output = "experiments-output/counterparts";
    std::vector<std::string> objects{"statuette", "hand", "teapot", "vase", "chair"}, pairs, cases;
    std::vector<std::string> ways{"nearest", "surface", "one-to-one", "sliding"};
    std::uint64_t vertices = 3000, seed = 1;
    double strength = 0.2;
    void declare_options(OptionList& list) {
        list("objects", objects, "names of synthetic objects");
        list("pairs", pairs, "TEMPLATE=MEMBER: mesh files in correspondence");
        list("cases", cases, "cases by name or number, from 1; empty: all");
        list("ways", ways, "nearest, or values of 'ostraka fit --counterparts'");
        list("vertices", vertices, "number of vertices of the template; more if the object needs them");
        list("seed", seed, "random seed of the other member and its fragments");
        list("strength", strength, "standard deviation of the logarithm of the size of parts");
        list("output", output, "output folder");
    }
};

/// Two members of a class: the template with the true position of each vertex on the other, and a mesh of the other.
struct Members {
    std::string name;
    Mesh shape;
    std::vector<int> labels;  ///< per face
    std::vector<Point> truth;
    Mesh other;
    std::vector<int> other_labels;
};

/// Number of edges whose faces form an angle of more than 120 degrees.
std::size_t count_folds(const Mesh& mesh) {
    std::size_t folds = 0;
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e), g = mesh.opposite(h);
        if (mesh.is_border(h) || mesh.is_border(g)) continue;
        const Vector a = area_vector(mesh, mesh.face(h)), b = area_vector(mesh, mesh.face(g));
        if (a * b < -0.5 * std::sqrt(a.squared_length() * b.squared_length())) ++folds;
    }
    return folds;
}

bool sound(const Mesh& mesh, const Mesh& before) {
    return count_folds(mesh) <= count_folds(before) && self_intersections(to_soup(mesh)).pairs.empty();
}

/// Random side lengths, taper and bend of the whole, and size and position of each part; each part's change fades out around
/// it.
class MemberWarp {
public:
    MemberWarp(const SyntheticMesh& made, std::size_t parts, double strength, Random& random)
        : diagonal_(box_diagonal(made.mesh)) {
        for (const Point& p : made.mesh.points()) box_.extend(eigen(p));
        for (int axis = 0; axis < 3; ++axis) sides_[axis] = std::exp(0.5 * strength * random.normal());
        taper_ = 0.5 * strength * random.normal();
        bend_ = 0.25 * strength * Eigen::Vector2d(random.normal(), random.normal());
        for (std::size_t k = 0; k < parts; ++k) {
            std::vector<Point> places;
            Part part;
            for (const Vertex v : made.mesh.vertices()) {
                if (made.vertex_labels[v] != static_cast<int>(k)) continue;
                places.push_back(made.mesh.point(v));
                part.centre += eigen(places.back());
            }
            part.centre /= std::max<double>(1, static_cast<double>(places.size()));
            part.tree = PointTree(places);
            part.scale = std::exp(strength * random.normal());
            part.shift = 0.1 * strength * diagonal_ * normal_vector(random);
            if (!places.empty()) parts_.push_back(std::move(part));
        }
    }

    Vector3d operator()(const Vector3d& p) const {
        Vector3d sum = Vector3d::Zero();
        double weights = 0;
        for (const Part& part : parts_) {
            const double off = std::sqrt(part.tree.nearest(point_of(p)).squared) / (fade * diagonal_),
                         weight = std::exp(-off * off);
            sum += weight * ((part.scale - 1) * (p - part.centre) + part.shift);
            weights += weight;
        }
        Vector3d q = p + sum / std::max(1.0, weights) - box_.center();
        const double height = box_.sizes().z(), up = 2 * q.z() / height;
        q.head<2>() *= std::exp(taper_ * up);
        q.head<2>() += 0.5 * height * up * up * bend_;
        return sides_.cwiseProduct(q);
    }

private:
    static constexpr double fade = 0.1;  // as a share of the diagonal
    struct Part {
        Vector3d centre = Vector3d::Zero(), shift;
        PointTree tree;
        double scale = 1;
    };
    double diagonal_;
    Eigen::AlignedBox3d box_;
    Vector3d sides_;
    double taper_;
    Eigen::Vector2d bend_;
    std::vector<Part> parts_;
};

Members make_members(const std::string& name, const CounterpartOptions& options, bool same_mesh) {
    const SyntheticObject& object = synthetic_object(name);
    MakeOptions how;
    how.vertices = std::max<std::uint64_t>(options.vertices, object.minimum_vertices);
    how.seed = 1;
    const SyntheticMesh made = make_mesh(object, how);
    how.seed = 2;
    how.vertices = how.vertices * 5 / 4;
    const SyntheticMesh again = same_mesh ? made : make_mesh(object, how);
    for (std::uint64_t attempt = 0; attempt < 100; ++attempt) {
        Random random(options.seed, attempt);
        const MemberWarp warp(made, object.parts.size(), options.strength, random);
        Members members{name,
                        made.mesh,
                        {made.face_labels.begin(), made.face_labels.end()},
                        {},
                        warped(again.mesh, warp),
                        {again.face_labels.begin(), again.face_labels.end()}};
        const Mesh truth = warped(made.mesh, warp);
        if (!sound(truth, made.mesh) || !sound(members.other, again.mesh)) continue;
        members.truth = ostraka::points_of(truth);
        return members;
    }
    throw Error(ErrorKind::failure, name, "no sound member was drawn", "take a smaller --strength");
}

/// Reads meshes in correspondence: the template is the first, simplified; the other is the second.
Members read_members(const std::string& pair, const CounterpartOptions& options) {
    const auto [first_file, second_file] = split_pair(pair);
    const Mesh first = read_mesh(first_file).mesh, second = read_mesh(second_file).mesh;
    if (first.number_of_vertices() != second.number_of_vertices() || first.number_of_faces() != second.number_of_faces())
        fail_input(pair, "are not in correspondence: their vertices or faces are not as many");
    Members members{Path(second_file).stem().string(),
                    simplified(first, options.vertices),
                    {},
                    {},
                    simplified(second, options.vertices * 5 / 4),
                    {}};
    std::vector<Point> centres;
    for (const Index v : spread_out(first, all_vertices(first), 10)) centres.push_back(first.point(Vertex(v)));
    const PointTree tree(centres);
    std::vector<int> labels;  // cells around the centres
    for (const Face f : first.faces()) labels.push_back(static_cast<int>(tree.nearest(centroid(first, f)).index));
    const SurfaceSearch on_first(first), on_second(second);
    for (const Vertex v : members.shape.vertices()) {
        const SurfaceHit hit = on_first.closest(members.shape.point(v));
        members.truth.push_back(point_at(second, hit.face, hit.barycentric));
    }
    for (const Face f : members.shape.faces())
        members.labels.push_back(labels[on_first.closest(centroid(members.shape, f)).face]);
    for (const Face f : members.other.faces())
        members.other_labels.push_back(labels[on_second.closest(centroid(members.other, f)).face]);
    return members;
}

struct Case {
    std::string name;
    bool same_mesh = false;
    double share = 1, noise = 0, holes = 0, scale = 1;
    double annotated = 1;  ///< share of the annotations used
};

const std::vector<Case> cases{{"same mesh", true},
                              {"same mesh, 60 %", true, 0.6, 0.001},
                              {"whole", false},
                              {"whole, noise", false, 1, 0.003},
                              {"whole, holes", false, 1, 0.001, 0.02},
                              {"whole, 1.3 times", false, 1, 0.001, 0, 1.3},
                              {"60 %", false, 0.6, 0.001},
                              {"30 %", false, 0.3, 0.001},
                              {"whole, half annotated", false, 1, 0.001, 0, 1, 0.5},
                              {"60 %, half annotated", false, 0.6, 0.001, 0, 1, 0.5},
                              {"whole, bare", false, 1, 0.001, 0, 1, 0},
                              {"60 %, bare", false, 0.6, 0.001, 0, 1, 0}};

/// Regions by label and landmarks, with only the first share of them.
AnnotationSet annotate(const Mesh& mesh, const std::vector<int>& labels, const std::vector<Index>& landmarks, double share) {
    AnnotationSet set;
    const auto skipped = [&](std::size_t i) { return share <= 0 || (share < 1 && i % 2 == 1); };
    AnnotationSet all = regions_from_labels(mesh, labels);
    for (Annotation& region : all.annotations)
        if (!skipped(static_cast<std::size_t>(region.id))) set.annotations.push_back(std::move(region));
    for (std::size_t i = 0; i < landmarks.size(); ++i)
        if (landmarks[i] != no_index && !skipped(i))
            set.annotations.push_back(landmark(1000 + static_cast<int>(i), "landmark " + std::to_string(i), landmarks[i]));
    return set;
}

/// Vertices between parts.
std::vector<Index> joints(const Mesh& mesh, const std::vector<int>& labels) {
    std::vector<bool> between(mesh.number_of_vertices(), false);
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e), g = mesh.opposite(h);
        if (mesh.is_border(h) || mesh.is_border(g) || labels[mesh.face(h)] == labels[mesh.face(g)]) continue;
        between[mesh.source(h)] = between[mesh.target(h)] = true;
    }
    return flagged(between);
}

struct Scene {
    AnnotationSet set;
    Fragment fragment;
    Motion to_piece;         ///< from the frame of the truth
    std::vector<bool> seen;  ///< per template vertex
};

Scene make_scene(const Members& members, const Case& test, std::uint64_t seed) {
    FragmentOptions breaking;
    breaking.share = test.share;
    breaking.noise = test.noise;
    breaking.seed = seed;
    Random random(seed, 99);
    const Point at = members.other.point(Vertex(static_cast<Index>(random.below(members.other.number_of_vertices()))));
    const SyntheticFragment piece = generate_fragment(members.other, at, breaking);
    std::vector<bool> keep(piece.mesh.number_of_faces(), true);
    for (int hole = 0; test.holes > 0 && hole < 5; ++hole) {
        const auto middle = static_cast<Index>(random.below(piece.mesh.number_of_vertices()));
        for (const Index f : disc(piece.mesh, Vertex(middle), test.holes)) keep[f] = false;
    }
    SubMesh left = keep_faces(piece.mesh, keep, true);
    Scene scene;
    scene.to_piece = piece.pose.inverse();
    if (test.scale != 1) {
        left.mesh = scaled_by(left.mesh, test.scale);
        Motion larger;
        larger.scale = test.scale;
        scene.to_piece = larger.after(scene.to_piece);
    }
    std::vector<Index> marks = spread_out(members.shape, joints(members.shape, members.labels), 8);
    const std::vector<Index> free_marks = spread_out(members.shape, all_vertices(members.shape), 12);
    marks.insert(marks.end(), free_marks.begin(), free_marks.end());
    const PointTree tree(ostraka::points_of(left.mesh));
    const double edge = mean_edge_length(left.mesh);
    const auto there = [&](Index v) {
        return tree.nearest(point_of(scene.to_piece(eigen(members.truth[v]))), edge + 3 * test.noise * box_diagonal(left.mesh));
    };
    std::vector<Index> their_marks;
    for (const Index v : marks) their_marks.push_back(there(v).index);
    std::vector<int> labels;
    for (const Index f : left.faces) labels.push_back(members.other_labels[piece.faces[f]]);
    scene.set = annotate(members.shape, members.labels, marks, test.annotated);
    scene.fragment.name = test.name;
    scene.fragment.annotations = annotate(left.mesh, labels, their_marks, test.annotated);
    scene.fragment.mesh = std::move(left.mesh);
    for (const Vertex v : members.shape.vertices()) scene.seen.push_back(there(v).index != no_index);
    return scene;
}

struct Result {
    bool placed = false;
    double all = 0, seen = 0, missing = 0;  ///< mean distance from the true positions, share of the diagonal
    double seconds = 0;
    std::size_t folds = 0, crossings = 0;
    double rigid = 0;
};

Result run(const Members& members, const Scene& scene, const std::string& way) {
    ReconstructOptions how;
    how.completion.join = false;
    set_option(how.fit, "counterparts", way == "nearest" ? "surface" : way);
    if (way == "nearest") {
        how.annotations.min_score = 1;  // no annotation reaches this score except landmarks
        how.fit.outlines = false;
    }
    const Stopwatch watch;
    const Reconstruction result = reconstruct({members.shape, scene.set}, {}, {&scene.fragment}, how);
    Result row;
    row.placed = result.placement.any();
    if (!row.placed) return row;
    row.seconds = watch.seconds().processor;
    const Motion frame = result.placement.fragments[0].pose.after(scene.to_piece);
    std::vector<Vector3d> truth;
    Eigen::AlignedBox3d box;
    for (const Point& p : members.truth) box.extend(truth.emplace_back(frame(eigen(p))));
    const double diagonal = box.diagonal().norm();
    std::vector<double> all, seen, missing, rigid;
    for (const Vertex v : members.shape.vertices()) {
        all.push_back((eigen(result.points[v]) - truth[v]).norm() / diagonal);
        (scene.seen[v] ? seen : missing).push_back(all.back());
        rigid.push_back((result.placement.scale * eigen(members.shape.point(v)) - truth[v]).norm() / diagonal);
    }
    row.all = mean_of(all), row.seen = mean_of(seen), row.missing = mean_of(missing), row.rigid = mean_of(rigid);
    const Mesh fitted = with_points(members.shape, result.points);
    row.folds = count_folds(fitted);
    row.crossings = self_intersections(to_soup(fitted)).pairs.size();
    return row;
}

/// Adds a row to the table, and one for each way to the file.
void judge(const Members& members, const Case& test, const CounterpartOptions& options, Table& table, Rows& csv) {
    const Scene scene = make_scene(members, test, options.seed);
    std::string cells = members.name + " | " + test.name;
    for (const std::string& way : options.ways) {
        const Result row = run(members, scene, way);
        cells += row.placed ? fmt::format(" | {:.3f} ({:.3f}; {:.2f} s; {}, {})", 100 * row.all, 100 * row.seen, row.seconds,
                                          row.folds, row.crossings)
                            : " | not placed";
        csv(members.name, test.name, way, row.placed, row.all, row.seen, row.missing, row.rigid, row.folds, row.crossings,
            row.seconds);
    }
    table.add(cells);
}

bool wanted(const Case& test, std::size_t number, const std::vector<std::string>& list) {
    const auto names = [&](const std::string& word) { return word == test.name || word == std::to_string(number); };
    return list.empty() || std::any_of(list.begin(), list.end(), names);
}

void counterparts(const CounterpartOptions& options) {
    Rows csv("object,case,counterparts,placed,all,seen,missing,rigid,folds,crossings,seconds");
    fmt::print(
        "Mean distance of vertices from their true places, % of the diagonal (where observed; seconds of the processor; edges "
        "folded, pairs of faces that cross).\n\n");
    Table table(fmt::format("object | case | {}", fmt::join(options.ways, " | ")));
    std::vector<std::string> names = options.objects;
    names.insert(names.end(), options.pairs.begin(), options.pairs.end());
    for (const std::string& name : names) {
        const bool pair = name.find('=') != std::string::npos;
        std::map<bool, Members> members;  // by whether they have the same mesh
        for (std::size_t c = 0; c < cases.size(); ++c) {
            const Case& test = cases[c];
            if (!wanted(test, c + 1, options.cases) || (pair && test.same_mesh)) continue;
            if (!members.contains(test.same_mesh))
                members.emplace(test.same_mesh, pair ? read_members(name, options) : make_members(name, options, test.same_mesh));
            judge(members.at(test.same_mesh), test, options, table, csv);
        }
    }
    csv.write(Path(options.output) / "counterparts.csv");
}

const Registration registered("counterparts", "templates fitted to other members: how far vertices end from their true places",
                              counterparts);

}  // namespace

}  // namespace ostraka::experiments
