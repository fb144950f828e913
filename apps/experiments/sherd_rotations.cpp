// Five scanned sherds of a vessel, moved at random, and the surface of revolution made of them as template: recovers axes,
// heights and rotations.
#include "breaks.h"
#include "experiments.h"
#include "report.h"

#include "ostraka/core/file.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reconstruction/assembly.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/revolution/surface_of_revolution.h"
#include "ostraka/stats/random.h"

#include <CGAL/boost/graph/helpers.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <sstream>

namespace ostraka::experiments {

using Eigen::Vector3d;

Motion random_motion(Random& random, double far) {
    Motion motion;
    Eigen::Vector4d q(random.normal(), random.normal(), random.normal(), random.normal());
    q.normalize();
    motion.rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    motion.translation = far * Vector3d(random.normal(), random.normal(), random.normal());
    return motion;
}

double degrees_of(const Motion& motion) { return 180 / std::numbers::pi * Eigen::AngleAxisd(motion.rotation).angle(); }

double off_of(const Mesh& mesh, const Motion& motion) {
    double squares = 0;
    for (const Vertex v : mesh.vertices()) squares += (motion(eigen(mesh.point(v))) - eigen(mesh.point(v))).squaredNorm();
    return std::sqrt(squares / static_cast<double>(mesh.number_of_vertices()));
}

std::vector<std::pair<std::string, Mesh>> scanned_sherds(const std::string& data) {
    std::vector<std::pair<std::string, Mesh>> sherds;
    for (int k = 1; k <= 5; ++k) {
        const Path file = Path(data) / "fragments-vessel-sherds" / ("TU_96_2_5f_piece0" + std::to_string(k) + ".obj");
        if (!std::filesystem::exists(file)) {
            std::cerr << "SKIPPED: " << file.string() << " is not there; name the folder with --data\n";
            return {};
        }
        sherds.emplace_back(std::to_string(k), read_mesh(file).mesh);
    }
    return sherds;
}

void sherd_rotations(const BreakExperiment& options) {
    const auto sherds = scanned_sherds(options.data);
    if (sherds.empty()) return;
    std::vector<Fragment> given(sherds.size());
    std::vector<const Fragment*> pointers;
    TriangleSoup all;
    for (std::size_t k = 0; k < sherds.size(); ++k) {
        given[k].name = sherds[k].first;
        given[k].mesh = sherds[k].second;
        pointers.push_back(&given[k]);
        for (const Vertex v : given[k].mesh.vertices()) {
            const Point p = given[k].mesh.point(v);
            all.points.push_back({p.x(), p.y(), p.z()});
        }
    }
    Vector3d low = Vector3d::Constant(1e300), high = -low;
    for (const auto& p : all.points)
        low = low.cwiseMin(Vector3d(p[0], p[1], p[2])), high = high.cwiseMax(Vector3d(p[0], p[1], p[2]));
    const double diagonal = (high - low).norm();
    const RevolutionTemplate turned = template_of_revolution(pointers);
    const Vector3d axis = eigen(turned.axis.direction);
    for (Fragment& one : given) one.facets = find_facets(one.mesh).of_face;
    std::ostringstream csv;
    csv << "motion,sherd,decided,degrees,percent,axis_degrees,height,overlap\n";
    std::cout
        << "| motion | joints decided, of these right | worst relative turn of decided joints, degrees | sherds off as a whole: "
           "degrees, % of the diagonal | overlap % | closed | crossings | s |\n|---|---|---|---|---|---|---|---|\n";
    for (int round = 1; round <= options.motions; ++round) {
        Random random(static_cast<std::uint64_t>(round), 5);
        std::vector<Fragment> moved_sherds(given.size());
        std::vector<Motion> motions;
        for (std::size_t k = 0; k < given.size(); ++k) {
            motions.push_back(random_motion(random, diagonal));
            moved_sherds[k].name = given[k].name;
            moved_sherds[k].facets = given[k].facets;
            moved_sherds[k].mesh = moved(given[k].mesh, motions[k]);
            pointers[k] = &moved_sherds[k];
        }
        const Stopwatch watch;
        const Reconstruction result = reconstruct(turned.mesh, turned.annotations, {}, pointers);
        const double seconds = watch.seconds().processor;
        std::size_t decided = 0, right = 0;
        double worst = 0;
        std::vector<Vector3d> from, to;
        std::vector<Motion> back(given.size());
        for (std::size_t k = 0; k < given.size(); ++k) {
            if (!result.placement.fragments[k].problem.empty()) continue;
            back[k] = result.placement.fragments[k].pose.after(motions[k]);
            for (const Vertex v : given[k].mesh.vertices()) {
                from.push_back(eigen(given[k].mesh.point(v)));
                to.push_back(back[k](from.back()));
            }
        }
        if (from.empty()) {
            std::cout << "| " << round << " | none placed |\n";
            continue;
        }
        const Motion common = fit_motion(from, to).inverse();
        if (result.rotations)
            for (const BreakJoint& joint : result.rotations->joints) {
                const Motion between =
                    back[static_cast<std::size_t>(joint.first)].inverse().after(back[static_cast<std::size_t>(joint.second)]);
                const double off = degrees_of(between);
                std::cerr << "motion " << round << ": " << joint.first + 1 << " - " << joint.second + 1
                          << format(": %.2f degrees, contact %.2f, rim %.2f, share %.2f, lead %.2f, confidence %.2f%s%s\n", off,
                                    joint.contact, joint.rim, joint.share, joint.lead, joint.confidence,
                                    joint.carries ? ", carries" : "", joint.decided ? ", decided" : "");
                if (!joint.decided) continue;
                ++decided;
                worst = std::max(worst, off);
                right += off < 5 ? 1 : 0;
            }
        double degrees = 0, percent = 0, overlap = 0;
        for (std::size_t k = 0; k < given.size(); ++k) {
            const Motion off = common.after(back[k]);
            const double d = degrees_of(off), p = 100 * off_of(given[k].mesh, off) / diagonal,
                         shared = result.rotations ? result.rotations->overlap[k] : 0;
            degrees = std::max(degrees, d), percent = std::max(percent, p), overlap = std::max(overlap, 100 * shared);
            const Vector3d turned_axis = back[k].rotation * axis;
            csv << round << ',' << given[k].name << ',' << result.placement.fragments[k].problem.empty() << ',' << d << ',' << p
                << ',' << 180 / std::numbers::pi * std::acos(std::min(1.0, std::abs(turned_axis.dot(axis)))) << ','
                << (back[k](eigen(turned.axis.point)) - eigen(turned.axis.point)).dot(axis) << ',' << shared << '\n';
        }
        const bool closed = CGAL::is_closed(result.object.mesh);
        std::cout << "| " << round
                  << format(" | %zu, %zu | %.1f | %.1f, %.2f | %.1f | %s | %zu | %.1f |\n", decided, right, worst, degrees,
                            percent, overlap, closed ? "yes" : "no", result.crossings, seconds);
        MeshExtras extras;
        for (const int fragment : result.object.fragment) extras.face_labels.push_back(fragment + 1);
        write_mesh(Path(options.output) / ("completed-" + std::to_string(round) + ".ply"), result.object.mesh, extras);
    }
    write_file(Path(options.output) / "sherd-turns.csv", csv.str());
}

}  // namespace ostraka::experiments
