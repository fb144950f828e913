// mesh register
#include "operations/registered.h"

#include "ostraka/core/angles.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/measure/measure.h"
#include "ostraka/registration/pose_json.h"
#include "ostraka/transfer/moved_annotations.h"

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
        p.input_option("annotations", Kind::annotations, annotations,
                       "annotations of the source (.ant.json), moved with the source");
        p.output_option("annotations-out", Kind::annotations, annotations_out,
                        "moved annotations to write (.ant.json), for the registered source");
        p.options("target-unit", target_unit,
                  "unit of the target's coordinates (any text, such as mm), for the moved annotations; by default their unit, "
                  "converted by the scale");
        options.declare_options(p.options);
        p.report.values(text("verdict", "verdict"), any("matrix"), number("scale", "scale"),
                        number("rotation", "rotation", "degrees"), numbers("axis", "about"),
                        numbers("translation", "translation", "length"), number("rms", "rms", "length"),
                        number("rmsOfDiagonal", "", "fraction of the diagonal"), number("largest", "99 % within", "length"),
                        number("share", "", "fraction of the points"), number("close", "", "fraction of the points"),
                        number("tolerance", "tolerance", "length"), number("mirroredRms", "rms if mirrored", "length"),
                        number("mirroredShare", "", "fraction of the points"), any("others"), text("slides"),
                        number("rotationUncertainty", "", "degrees"), number("translationUncertainty", "", "length"),
                        number("scaleUncertainty", "", "fraction of the scale"), number("placementUncertainty", "", "length"),
                        integer("undetermined"));
    }

    void check() const override {
        if (static_cast<bool>(annotations) != static_cast<bool>(annotations_out))
            fail_usage(annotations ? "--annotations without --annotations-out" : "--annotations-out without --annotations",
                       "give both, or neither");
        if (annotations && !output) fail_usage("--annotations without the registered mesh", "name the mesh to write");
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
        report_uncertainty(registration, report);
        report.notes(remarks_on(registration));
        report.line(message_about(registration, diagonal));
        if (registration.verdict != RegistrationVerdict::aligned) return report.answer_no();
        if (matrix) matrix.write(pose_to_json(registration.motion, report.allocator()));
        if (!output) return;
        Mesh result = moved(source_mesh, registration.motion);
        if (annotations) write_annotations(result, registration.motion, report);
        output.write(std::move(result), source->extras);
    }

private:
    static void report_uncertainty(const MeshRegistration& registration, Report& report) {
        const RegistrationUncertainty& u = registration.uncertainty;
        report("rotationUncertainty", u.rotation / degree)("translationUncertainty", u.translation)("scaleUncertainty", u.scale)(
            "placementUncertainty", u.placement)("undetermined", u.undetermined);
        if (registration.verdict != RegistrationVerdict::aligned) return;
        report.text_only("uncertainty", fmt::format("{} degrees, centre {}, scale {}, points {} (standard deviations)",
                                                    number(u.rotation / degree, 2), number(u.translation, 2), number(u.scale, 2),
                                                    number(u.placement, 2)));
        if (u.undetermined > 0)
            report.note(fmt::format("{} of the motions {} not determined by the shape and not part of the uncertainty",
                                    u.undetermined, u.undetermined == 1 ? "is" : "are"));
    }

    void write_annotations(const Mesh& result, const Motion& motion, Report& report) const {
        const AnnotationSet& set = annotations.on(source->mesh);
        const std::string unit = target_unit.empty() ? unit_scaled(set.unit, motion.scale) : target_unit;
        if (unit.empty() && !set.unit.empty())
            report.note(
                fmt::format("the scale {} leads from {} to no known unit: the moved annotations have no unit; give it with "
                            "--target-unit",
                            number(motion.scale), set.unit));
        AnnotationSet moved_set = moved_annotations({source->mesh, set}, motion, unit);
        report.notes(refresh_measures(result, moved_set).notes);
        annotations_out.write(std::move(moved_set), result, output.file_name());
    }

    MeshInput source, target;
    MeshOutput output;
    AnnotationsInput annotations;
    AnnotationsOutput annotations_out;
    std::string target_unit;
    JsonOutput matrix;
    MeshRegistrationOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_register() { return make<MeshRegister>(); }

}  // namespace ostraka
