// Shape modes of faces and bodies in known correspondence, and how well fits recover the correspondence.
#include "classes.h"
#include "report.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/shape_classes/shape_class.h"
#include "ostraka/stats/random.h"

#include <algorithm>
#include <iostream>
#include <sstream>

namespace ostraka::experiments {

namespace {

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
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        Annotation annotation;
        annotation.id = static_cast<int>(i);
        annotation.tag = "landmark " + std::to_string(i + 1);
        annotation.type = AnnotationType::point;
        annotation.points = {vertices[i]};
        set.annotations.push_back(std::move(annotation));
    }
    return set;
}

/// Reports a fit with known truth: the distance of each vertex from its true position, and from the tangent plane there.
void report_fit(const std::string& name, const Mesh& from, const AnnotationSet& set, const WholeObject& to, bool guides) {
    const WholeObject bare{to.name, to.mesh, {}};
    const WholeObject& object = guides ? to : bare;
    const Stopwatch watch;
    const MemberFit fit = fit_member(from, set, object);
    const double seconds = watch.seconds().processor;
    if (!fit.problem.empty()) {
        std::cout << "| " << name << " | " << (guides ? "yes" : "no") << " | " << fit.problem << " |\n";
        return;
    }
    std::vector<double> off, rigid;
    const double diagonal = box_diagonal(to.mesh);
    const Landmarks start = landmarks_of({from.points().begin(), from.points().end()}),
                    goal = landmarks_of({to.mesh.points().begin(), to.mesh.points().end()});
    ProcrustesOptions scaled;
    scaled.scaling = true;
    const Landmarks aligned = procrustes(start, goal, scaled).apply(start);
    for (const Vertex v : to.mesh.vertices()) {
        off.push_back((eigen(fit.points[v]) - eigen(to.mesh.point(v))).norm() / diagonal);
        rigid.push_back((aligned.row(static_cast<Eigen::Index>(v.idx())) - goal.row(static_cast<Eigen::Index>(v.idx()))).norm() /
                        diagonal);
    }
    const auto row = [](std::vector<double> list) {
        std::sort(list.begin(), list.end());
        double sum = 0;
        for (const double x : list) sum += x / static_cast<double>(list.size());
        return format("%.3f | %.3f | %.3f", 100 * sum, 100 * list[list.size() / 2], 100 * list[list.size() * 95 / 100]);
    };
    std::cout << "| " << name << " | " << (guides ? "yes" : "no") << " | " << fit.placed_by << " | " << row(off) << " | "
              << row(rigid) << " | " << format("%.3f | %.1f |\n", 100 * fit.residuals->distance, seconds) << std::flush;
}

void head(const char* title) {
    std::cout << "\n## " << title
              << "\n\n| from, to | landmarks | laid on by | error mean % | median | 95 % | similarity alone: mean | median | 95 "
                 "% | surface "
                 "distance | s |\n|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
}

}  // namespace

void class_correspondence(const ClassCorrespondenceOptions& options) {
    if (options.faces.size() < 3) fail_usage("there are too few faces", "give the neutral one, then two or more identities");
    std::vector<WholeObject> faces;
    std::vector<Index> old;
    for (const std::string& file : options.faces) {
        SubMesh part = shell(read_mesh(file).mesh, options.face_vertices);
        faces.push_back({Path(file).stem().string(), std::move(part.mesh), {}});
        old = std::move(part.vertices);
    }
    std::vector<Index> marks;
    for (const Index v : read_indices(options.landmarks)) {
        const auto found = std::find(old.begin(), old.end(), v);
        if (found != old.end()) marks.push_back(static_cast<Index>(found - old.begin()));
    }
    const AnnotationSet set = landmarks_on(marks);
    for (WholeObject& face : faces) face.annotations = landmarks_on(marks);

    // Members neutral + sum a_i (identity_i - neutral): the span of the modes is that of the identities, up to rotation and
    // scale.
    std::vector<Landmarks> basis, members;
    const auto points = [](const Mesh& mesh) { return landmarks_of({mesh.points().begin(), mesh.points().end()}); };
    const Landmarks neutral = points(faces[0].mesh);
    for (std::size_t i = 1; i < faces.size(); ++i) basis.push_back(points(faces[i].mesh) - neutral);
    Random random(options.seed);
    for (int k = 0; k < options.made; ++k) {
        Landmarks shape = neutral;
        for (const Landmarks& identity : basis) shape += 0.5 * random.normal() * identity;
        members.push_back(shape);
    }
    ModeOptions how;
    how.sizes = true;
    const ShapeModes modes = learn_modes(members, neutral, how);
    std::cout << "## Modes of " << options.made << " faces made from " << basis.size() << " identities\n\n"
              << modes.variances.size() << " modes; % of the variance, one after another:";
    for (std::size_t k = 0; k < modes.variances.size() && k < basis.size() + 3; ++k)
        std::cout << format(" %.4f", 100 * modes.variances[k] / modes.total);
    std::cout << "\n\n| identity | share of its field given by the modes |\n|---|--:|\n";
    for (std::size_t i = 0; i < basis.size(); ++i) {
        // Residual of the first modes for the face with this identity at full strength.
        ShapeModes first = modes;
        const auto count = std::min<std::size_t>(basis.size(), modes.variances.size());
        first.modes = modes.modes.topRows(static_cast<Eigen::Index>(count));
        first.variances.resize(count);
        const ShapeCoordinates at = coordinates_in(first, neutral + basis[i]);
        const double whole = at.distance * modes.mean_size, left = at.outside * modes.mean_size;
        std::cout << "| " << faces[i + 1].name << " | " << format("%.6f |\n", 1 - left * left / (whole * whole));
    }

    head("One face fitted to another");
    for (std::size_t i = 1; i < faces.size(); ++i)
        for (const bool guides : {false, true})
            report_fit(faces[0].name + ", " + faces[i].name, faces[0].mesh, set, faces[i], guides);
    if (options.body.empty()) return;

    // The skin of the base, deformed by targets: "vertex dx dy dz".
    const MeshFile base = read_mesh(options.body);
    const SubMesh skin = shell(base.mesh, options.body_vertices);
    std::vector<Index> place(base.mesh.number_of_vertices(), no_index);
    for (std::size_t v = 0; v < skin.vertices.size(); ++v) place[skin.vertices[v]] = static_cast<Index>(v);
    // Landmarks: vertices chosen by farthest-point sampling of the skin.
    std::vector<Index> spread;
    std::vector<double> nearest(skin.mesh.number_of_vertices(), 1e300);
    for (Index next = 0; spread.size() < 40;) {
        spread.push_back(next);
        for (const Vertex v : skin.mesh.vertices())
            nearest[v] = std::min(nearest[v], (eigen(skin.mesh.point(v)) - eigen(skin.mesh.point(Vertex(next)))).norm());
        next = static_cast<Index>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    }
    const AnnotationSet body_set = landmarks_on(spread);
    head("One body fitted to another (landmarks: 40 vertices spread over the skin)");
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
        const WholeObject body{Path(file).stem().string(), with_points(skin.mesh, moved), landmarks_on(spread)};
        for (const bool guides : {false, true}) report_fit("base, " + body.name, skin.mesh, body_set, body, guides);
    }
}

}  // namespace ostraka::experiments
