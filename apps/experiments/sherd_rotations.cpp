// Five scanned sherds of a vessel, moved at random, and the surface of revolution made of them as template: recovers axes,
// heights and rotations.
#include "sherds.h"

#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reconstruction/assembly.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/revolution/surface_of_revolution.h"

#include <CGAL/boost/graph/helpers.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>

namespace ostraka::experiments {

using Eigen::Vector3d;

std::vector<Fragment> scanned_sherds(const std::string& data) {
    std::vector<Fragment> sherds;
    for (int k = 1; k <= 5; ++k) {
        const Path file = Path(data) / "fragments-vessel-sherds" / fmt::format("TU_96_2_5f_piece0{}.obj", k);
        if (!std::filesystem::exists(file)) {
            std::cerr << "SKIPPED: " << file.string() << " is not there; name the folder with --data\n";
            return {};
        }
        sherds.emplace_back();
        sherds.back().name = std::to_string(k);
        sherds.back().mesh = read_mesh(file).mesh;
    }
    return sherds;
}

std::vector<const Fragment*> pointers_to(const std::vector<Fragment>& fragments) {
    std::vector<const Fragment*> pointers;
    for (const Fragment& fragment : fragments) pointers.push_back(&fragment);
    return pointers;
}

namespace {

/// Prints the decided joints; returns the number of decided and of right ones, and the largest relative rotation of decided
/// ones.
std::tuple<std::size_t, std::size_t, double> judge_joints(const std::vector<FractureJoint>& joints,
                                                          const std::vector<Motion>& back, int round) {
    std::size_t decided = 0, right = 0;
    double worst = 0;
    for (const FractureJoint& joint : joints) {
        const double off =
            degrees_of(back[static_cast<std::size_t>(joint.first)].inverse().after(back[static_cast<std::size_t>(joint.second)]));
        fmt::print(stderr,
                   "motion {}: {} - {}: {:.2f} degrees, contact {:.2f}, rim {:.2f}, share {:.2f}, lead {:.2f}, confidence "
                   "{:.2f}{}{}\n",
                   round, joint.first + 1, joint.second + 1, off, joint.contact, joint.rim, joint.share, joint.lead,
                   joint.confidence, joint.carries ? ", carries" : "", joint.decided ? ", decided" : "");
        if (!joint.decided) continue;
        ++decided;
        worst = std::max(worst, off);
        right += off < 5 ? 1 : 0;
    }
    return {decided, right, worst};
}

/// Places sherds on the surface of revolution made of them: errors of axes, heights and rotations.
void sherd_rotations(const SherdOptions& options) {
    std::vector<Fragment> given = scanned_sherds(options.data);
    if (given.empty()) return;
    CGAL::Bbox_3 bounds;
    for (const Fragment& one : given)
        for (const Vertex v : one.mesh.vertices()) bounds += one.mesh.point(v).bbox();
    const double diagonal =
        Vector3d(bounds.xmax() - bounds.xmin(), bounds.ymax() - bounds.ymin(), bounds.zmax() - bounds.zmin()).norm();
    const RevolutionTemplate turned = template_of_revolution(pointers_to(given));
    const Vector3d axis = eigen(turned.axis.direction), on_axis = eigen(turned.axis.point);
    for (Fragment& one : given) one.facets = find_facets(one.mesh).of_face;
    Rows csv("motion,sherd,decided,degrees,percent,axis_degrees,height,overlap");
    Table table(
        "motion | joints decided, of these right | worst relative turn of decided joints, degrees | sherds off as a whole: "
        "degrees, % of the diagonal | overlap % | closed | crossings | s");
    for (int round = 1; round <= options.motions; ++round) {
        Random random(static_cast<std::uint64_t>(round), 5);
        std::vector<Fragment> away = given;
        std::vector<Motion> motions;
        for (Fragment& one : away) {
            motions.push_back(random_motion(random, diagonal));
            one.mesh = moved(one.mesh, motions.back());
        }
        const Stopwatch watch;
        const Reconstruction result = reconstruct(turned, {}, pointers_to(away));
        const double seconds = watch.seconds().processor;
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
            table.row("{} | none placed", round);
            continue;
        }
        const Motion common = fit_motion(from, to).inverse();
        const auto [decided, right, worst] =
            judge_joints(result.rotations ? result.rotations->joints : std::vector<FractureJoint>(), back, round);
        double degrees = 0, percent = 0, overlap = 0;
        for (std::size_t k = 0; k < given.size(); ++k) {
            const Motion off = common.after(back[k]);
            const double d = degrees_of(off), p = 100 * off_of(given[k].mesh, off) / diagonal,
                         shared = result.rotations ? result.rotations->overlap[k] : 0;
            degrees = std::max(degrees, d), percent = std::max(percent, p), overlap = std::max(overlap, 100 * shared);
            const Vector3d turned_axis = back[k].rotation * axis;
            csv(round, given[k].name, result.placement.fragments[k].problem.empty(), d, p,
                180 / std::numbers::pi * std::acos(std::min(1.0, std::abs(turned_axis.dot(axis)))),
                (back[k](on_axis) - on_axis).dot(axis), shared);
        }
        table.row("{} | {}, {} | {:.1f} | {:.1f}, {:.2f} | {:.1f} | {} | {} | {:.1f}", round, decided, right, worst, degrees,
                  percent, overlap, CGAL::is_closed(result.object.mesh) ? "yes" : "no", result.crossings, seconds);
        MeshExtras extras;
        for (const int fragment : result.object.fragment) extras.face_labels.push_back(fragment + 1);
        write_mesh(Path(options.output) / fmt::format("completed-{}.ply", round), result.object.mesh, extras);
    }
    csv.write(Path(options.output) / "sherd-turns.csv");
}

const Registration registered("sherd-turns", "scanned sherds on the template turned from them, turns by breaks", sherd_rotations);

}  // namespace

}  // namespace ostraka::experiments
