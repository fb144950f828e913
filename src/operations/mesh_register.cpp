// mesh register
#include "registered.h"

#include "ostraka/core/angles.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/registration/pose_json.h"

namespace ostraka {

namespace {

struct MeshRegister final : Operation {
    void describe(Parameters& p) override {
        p.input("source", Kind::mesh, source, "the mesh that is moved");
        p.input("target", Kind::mesh, target, "the mesh of the same object, in any unit and place, at any resolution");
        p.output("output", Kind::mesh, output.with_encoding(), "the source, registered onto the target").optional();
        p.output_option("matrix", Kind::pose, matrix,
                        "JSON file to write: the transformation of the source as the rows of a 4 x 4 matrix");
        options.describe(p.options);
        p.report.values(text("verdict", "verdict"), any("matrix"), number("scale", "scale"),
                        number("rotation", "rotation", "degrees"), numbers("axis", "about"),
                        numbers("translation", "translation", "length"), number("rms", "rms", "length"), number("rmsOfDiagonal"),
                        number("largest", "99 % within", "length"), number("share"), number("close"),
                        number("tolerance", "tolerance", "length"), number("mirroredRms", "rms if mirrored", "length"),
                        number("mirroredShare"), any("others"), text("slides"));
    }

    void run(Context&, Report& report) override {
        const Mesh &from = source->mesh, &onto = target->mesh;
        const MeshRegistration found = registered(source, target, options);
        const double diagonal = box_diagonal(onto);
        const Eigen::AngleAxisd turn(found.motion.rotation);
        const auto list = [](const Eigen::Vector3d& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
        const SurfaceAgreement& agreement = found.agreement;
        report("verdict", to_string(found.verdict))("matrix", pose_to_json(found.motion, report.allocator()))(
            "scale", found.motion.scale)("rotation", turn.angle() / degree)("axis", list(turn.axis()))(
            "translation", list(found.motion.translation))(
            "rms", agreement.rms,
            number(agreement.rms, 4) + " (" + number(100 * agreement.rms / diagonal, 3) + " % of the diagonal)")(
            "rmsOfDiagonal", agreement.rms / diagonal)("largest", agreement.largest)("share", agreement.share)(
            "close", agreement.close)("tolerance", found.tolerance)("mirroredRms", found.mirrored.rms)("mirroredShare",
                                                                                                       found.mirrored.share)(
            "others", json_list(found.others, report.allocator(), [&](const Motion& pose) {
                return pose_to_json(pose, report.allocator());
            }))("slides", found.slippable.kind == SlippableKind::none ? "" : found.slippable.text());
        report.notes(remarks_on(found));
        report.line(in_words(found, diagonal));
        if (found.verdict != RegistrationVerdict::aligned) return report.answer_no();
        if (matrix) matrix.write(pose_to_json(found.motion, report.allocator()));
        if (output) output.write(moved(from, found.motion), source->extras);
    }

    MeshInput source, target;
    MeshOutput output;
    JsonOutput matrix;
    MeshRegistrationOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_register() { return make<MeshRegister>(); }

}  // namespace ostraka
