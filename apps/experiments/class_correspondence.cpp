// Shape modes of faces and bodies in known correspondence, and how well fits recover the correspondence.
#include "harness.h"
#include "scenes.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/shape_classes/member_fit.h"
#include "ostraka/shape_classes/shape_class.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <sstream>

namespace ostraka::experiments {

namespace {

struct ClassCorrespondenceOptions {
    std::vector<std::string> faces, targets;
    std::string landmarks, body;
    int made = 30;
    void declare_options(OptionList& list) {
        list("face", faces, "mesh files of faces in correspondence, the neutral one first").required();
        list("landmarks", landmarks, "file of vertex indices of a face, one per line").required();
        list("body", body, "mesh file of a body");
        list("target", targets, "files that move the body's vertices, with lines 'vertex dx dy dz'");
        list("made", made, "number of faces made for the modes", Range{2, 10000});
    }
};
constexpr std::size_t face_skin = 11248, body_skin = 13380;  // number of leading vertices that are skin

/// The largest connected component of the faces on vertices below `maximum`; other parts than skin are dropped. `vertices` are
/// the original indices.
SubMesh shell(const Mesh& mesh, std::size_t maximum) {
    std::vector<bool> keep(mesh.number_of_faces());
    for (const Face face : mesh.faces()) {
        const auto c = corners(mesh, face);
        keep[face] = std::all_of(c.begin(), c.end(), [&](Vertex v) { return v.idx() < maximum; });
    }
    return keep_faces(mesh, keep);
}

std::vector<Index> read_indices(const std::string& file) {
    std::istringstream lines(read_file(file));
    std::vector<Index> list;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line[0] != '#') list.push_back(static_cast<Index>(std::stoul(line)));
    return list;
}

AnnotationSet landmarks_on(const std::vector<Index>& vertices) {
    AnnotationSet set;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        set.annotations.push_back(landmark(static_cast<int>(i), "landmark " + std::to_string(i + 1), vertices[i]));
    return set;
}

Landmarks landmarks_of_mesh(const Mesh& mesh) { return landmarks_of({mesh.points().begin(), mesh.points().end()}); }

const std::string columns =
    "from, to | landmarks | laid on by | error mean % | median | 95 % | similarity alone: mean | median | 95 % | surface "
    "distance | s";

/// Reports a fit with known truth: the distance of each vertex from its true position, and from the tangent plane there.
void report_fit(const std::string& name, const Mesh& from, const AnnotationSet& set, const WholeObject& to, bool guides,
                Table& table) {
    const WholeObject bare{{to.mesh, {}}, to.name};
    const Stopwatch watch;
    const MemberFit fit = fit_member({from, set}, guides ? to : bare);
    const double seconds = watch.seconds().processor;
    const char* guided = guides ? "yes" : "no";
    if (!fit.problem.empty()) {
        table.row("{} | {} | {}", name, guided, fit.problem);
        return;
    }
    const double diagonal = box_diagonal(to.mesh);
    const Landmarks start = landmarks_of_mesh(from), goal = landmarks_of_mesh(to.mesh);
    ProcrustesOptions scaled;
    scaled.scaling = true;
    const auto off_goal = [&](const Landmarks& shape) {
        std::vector<double> off;
        for (Eigen::Index v = 0; v < goal.rows(); ++v) off.push_back((shape.row(v) - goal.row(v)).norm() / diagonal);
        return off;
    };
    const std::vector<double> off = off_goal(landmarks_of(fit.points)),
                              rigid = off_goal(procrustes(start, goal, scaled).apply(start));
    const auto row = [](std::vector<double> list) {
        std::sort(list.begin(), list.end());
        return fmt::format("{:.3f} | {:.3f} | {:.3f}", 100 * mean_of(list), 100 * list[list.size() / 2],
                           100 * list[list.size() * 95 / 100]);
    };
    table.row("{} | {} | {} | {} | {} | {:.3f} | {:.1f}", name, guided, fit.placed_by, row(off), row(rigid),
              100 * fit.residuals->distance, seconds);
}

/// Members neutral + sum a_i (identity_i - neutral): the span of the modes is that of the identities, up to rotation and scale.
void report_modes(const std::vector<WholeObject>& faces, int made) {
    std::vector<Landmarks> basis, members;
    const Landmarks neutral = landmarks_of_mesh(faces[0].mesh);
    for (std::size_t i = 1; i < faces.size(); ++i) basis.push_back(landmarks_of_mesh(faces[i].mesh) - neutral);
    Random random(1);
    for (int k = 0; k < made; ++k) {
        Landmarks& shape = members.emplace_back(neutral);
        for (const Landmarks& identity : basis) shape += 0.5 * random.normal() * identity;
    }
    ModeOptions how;
    how.sizes = true;
    const ShapeModes modes = learn_modes(members, neutral, how);
    fmt::print("## Modes of {} faces made from {} identities\n\n{} modes; % of the variance, one after another:", made,
               basis.size(), modes.variances.size());
    for (std::size_t k = 0; k < modes.variances.size() && k < basis.size() + 3; ++k)
        fmt::print(" {:.4f}", 100 * modes.variances[k] / modes.total);
    fmt::print("\n\n");
    Table table("identity | share of its field given by the modes");
    for (std::size_t i = 0; i < basis.size(); ++i) {
        // Residual of the first modes for the face with this identity at full strength.
        ShapeModes first = modes;
        const auto count = std::min<std::size_t>(basis.size(), modes.variances.size());
        first.modes = modes.modes.topRows(static_cast<Eigen::Index>(count));
        first.variances.resize(count);
        const ShapeCoordinates at = coordinates_in(first, neutral + basis[i]);
        const double whole = at.distance * modes.mean_size, left = at.outside * modes.mean_size;
        table.row("{} | {:.6f}", faces[i + 1].name, 1 - left * left / (whole * whole));
    }
}

void report_bodies(const ClassCorrespondenceOptions& options) {
    // The skin of the base, deformed by targets: "vertex dx dy dz".
    const MeshFile base = read_mesh(options.body);
    const SubMesh skin = shell(base.mesh, body_skin);
    std::vector<Index> place(base.mesh.number_of_vertices(), no_index);
    for (std::size_t v = 0; v < skin.vertices.size(); ++v) place[skin.vertices[v]] = static_cast<Index>(v);
    // Landmarks: vertices chosen by farthest-point sampling of the skin, from the first one.
    std::vector<Index> spread;
    std::vector<double> nearest(skin.mesh.number_of_vertices(), 1e300);
    for (Index next = 0; spread.size() < 40;) {
        spread.push_back(next);
        for (const Vertex v : skin.mesh.vertices())
            nearest[v] = std::min(nearest[v], (eigen(skin.mesh.point(v)) - eigen(skin.mesh.point(Vertex(next)))).norm());
        next = static_cast<Index>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    }
    fmt::print("\n## One body fitted to another (landmarks: 40 vertices spread over the skin)\n\n");
    Table table(columns);
    for (const std::string& file : options.targets) {
        std::vector<Point> moved(skin.mesh.points().begin(), skin.mesh.points().end());
        std::istringstream lines(read_file(file));
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::size_t v = 0;
            double x = 0, y = 0, z = 0;
            if (line.empty() || line[0] == '#' || !(words >> v >> x >> y >> z) || v >= place.size() || place[v] == no_index)
                continue;
            moved[place[v]] = moved[place[v]] + Vector(x, y, z);
        }
        const WholeObject body{{with_points(skin.mesh, moved), landmarks_on(spread)}, Path(file).stem().string()};
        for (const bool guides : {false, true})
            report_fit("base, " + body.name, skin.mesh, landmarks_on(spread), body, guides, table);
    }
}

void class_correspondence(const ClassCorrespondenceOptions& options) {
    if (options.faces.size() < 3) fail_usage("there are too few faces", "give the neutral one, then two or more identities");
    std::vector<WholeObject> faces;
    std::vector<Index> old;
    for (const std::string& file : options.faces) {
        SubMesh part = shell(read_mesh(file).mesh, face_skin);
        faces.push_back({{std::move(part.mesh), {}}, Path(file).stem().string()});
        old = std::move(part.vertices);
    }
    std::vector<Index> marks;
    for (const Index v : read_indices(options.landmarks))
        if (const auto found = std::find(old.begin(), old.end(), v); found != old.end())
            marks.push_back(static_cast<Index>(found - old.begin()));
    const AnnotationSet set = landmarks_on(marks);
    for (WholeObject& face : faces) face.annotations = set;
    report_modes(faces, options.made);
    fmt::print("\n## One face fitted to another\n\n");
    Table table(columns);
    for (std::size_t i = 1; i < faces.size(); ++i)
        for (const bool guides : {false, true})
            report_fit(faces[0].name + ", " + faces[i].name, faces[0].mesh, set, faces[i], guides, table);
    if (!options.body.empty()) report_bodies(options);
}

const Registration registered("class-correspondence", "modes and fits of faces and bodies in correspondence",
                              class_correspondence);

}  // namespace

}  // namespace ostraka::experiments
