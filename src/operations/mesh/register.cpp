// mesh register
#include "operations/registered.h"

#include "ostraka/core/angles.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/registration/pose_json.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct MeshRegister final : Operation {
    void declare(Parameters& p) override {
        p.input("source", Kind::mesh, source, "mesh that is moved onto the target");
        p.input("target", Kind::mesh, target, "mesh of the same object, in any unit, pose and resolution; it is not moved");
        p.output("output", Kind::mesh, output.with_ascii_option(), "mesh to write: the source registered onto the target")
            .optional();
        p.output_option("matrix", Kind::pose, matrix,
                        "JSON file to write: transformation of the source onto the target, as the rows of a 4 x 4 matrix");
        options.list_options(p.options);
        p.report.values(text("verdict", "verdict"), any("matrix"), number("scale", "scale"),
                        number("rotation", "rotation", "degrees"), numbers("axis", "about"),
                        numbers("translation", "translation", "length"), number("rms", "rms", "length"),
                        number("rmsOfDiagonal", "", "fraction of the diagonal"), number("largest", "99 % within", "length"),
                        number("share", "", "fraction of the points"), number("close", "", "fraction of the points"),
                        number("tolerance", "tolerance", "length"), number("mirroredRms", "rms if mirrored", "length"),
                        number("mirroredShare", "", "fraction of the points"), any("others"), text("slides"));
    }

    void run(Context&, Report& report) override {
        const Mesh &source_mesh = source->mesh, &target_mesh = target->mesh;
        const MeshRegistration registration = registered(source, target, options);
        const double diagonal = box_diagonal(target_mesh);
        const Eigen::AngleAxisd rotation(registration.motion.rotation);
        const auto coordinates = [](const Eigen::Vector3d& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
        const SurfaceAgreement& agreement = registration.agreement;
        report("verdict", to_string(registration.verdict))("matrix", pose_to_json(registration.motion, report.allocator()))(
            "scale", registration.motion.scale)("rotation", rotation.angle() / degree)("axis", coordinates(rotation.axis()))(
            "translation", coordinates(registration.motion.translation))(
            "rms", agreement.rms,
            fmt::format("{} ({} % of the diagonal)", number(agreement.rms, 4), number(100 * agreement.rms / diagonal, 3)))(
            "rmsOfDiagonal", agreement.rms / diagonal)("largest", agreement.largest)("share", agreement.share)(
            "close", agreement.close)("tolerance", registration.tolerance)("mirroredRms", registration.mirrored.rms)(
            "mirroredShare", registration.mirrored.share)(
            "others", json_list(registration.others, report.allocator(), [&](const Motion& pose) {
                return pose_to_json(pose, report.allocator());
            }))("slides", registration.slippable.kind == SlippableKind::none ? "" : registration.slippable.text());
        report.notes(remarks_on(registration));
        report.line(message_about(registration, diagonal));
        if (registration.verdict != RegistrationVerdict::aligned) return report.answer_no();
        if (matrix) matrix.write(pose_to_json(registration.motion, report.allocator()));
        if (output) output.write(moved(source_mesh, registration.motion), source->extras);
    }

    MeshInput source, target;
    MeshOutput output;
    JsonOutput matrix;
    MeshRegistrationOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_register() { return make<MeshRegister>(); }

}  // namespace ostraka
