#include "operations/mesh/motion_steps.h"

#include "ostraka/core/angles.h"
#include "ostraka/registration/pose_json.h"
#include "ostraka/vocabulary/text_match.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {

constexpr std::initializer_list<const char*> length_units{"um", "mm", "cm", "dm", "m", "km", "in", "ft"};

Vector3d three_numbers(const std::string& text, const std::string& option) {
    const auto numbers = numbers_of<double>(text, option);
    if (numbers.size() != 3 || !std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        fail_usage(fmt::format("{} is '{}'", option, printable(text, 60)), "give three finite numbers, like 10,0,-2.5");
    return {numbers[0], numbers[1], numbers[2]};
}

Vector3d unit_direction(const std::string& text, const std::string& option) {
    const auto direction = direction_of(text, option);
    const Vector3d v(direction[0], direction[1], direction[2]);
    return (v / v.cwiseAbs().maxCoeff()).normalized();
}

/// The matrix whose rows are the axes of a text such as "x,z,-y": the new x, y and z.
Matrix3d matrix_of_axes(const std::string& text) {
    if (text == "z-up") return matrix_of_axes("x,-z,y");
    if (text == "y-up") return matrix_of_axes("x,z,-y");
    const auto fail = [&] {
        fail_usage(fmt::format("--axes is '{}'", printable(text, 60)),
                   "give z-up (for an object whose y axis points up), y-up (for an object whose z axis points up), or the axes "
                   "that become x, y and z, each axis once: x,z,-y");
    };
    Matrix3d matrix = Matrix3d::Zero();
    const auto words = split_words(text, ",");
    if (words.size() != 3) fail();
    for (int row = 0; row < 3; ++row) {
        std::string_view word = words[static_cast<std::size_t>(row)];
        const bool negative = word.starts_with('-');
        if (negative || word.starts_with('+')) word.remove_prefix(1);
        if (word.size() != 1 || word[0] < 'x' || word[0] > 'z') fail();
        matrix(row, word[0] - 'x') = negative ? -1 : 1;
    }
    if ((matrix.cwiseAbs().colwise().sum().array() != 1).any()) fail();
    return matrix;
}

/// Cosine and sine of an angle in degrees, exact for multiples of 90.
std::pair<double, double> cosine_and_sine(double degrees) {
    const double turn = std::fmod(std::fmod(degrees, 360) + 360, 360);
    const double quarters = std::floor(turn / 90), rest = (turn - 90 * quarters) * degree;
    double c = rest == 0 ? 1 : std::cos(rest), s = rest == 0 ? 0 : std::sin(rest);
    for (int quarter = 0; quarter < static_cast<int>(quarters); ++quarter) c = -std::exchange(s, c);
    return {c, s};
}

/// The rotation of a text such as "z,90" or "0,0,1,90": an axis and an angle in degrees, counter-clockwise seen against the axis
/// (Rodrigues' formula).
Matrix3d rotation_of(const std::string& text) {
    const std::size_t comma = text.rfind(',');
    const auto degrees = comma == std::string::npos ? std::nullopt : number_of(std::string_view(text).substr(comma + 1));
    if (!degrees)
        fail_usage(fmt::format("--rotate is '{}'", printable(text, 60)),
                   "give an axis and an angle in degrees: z,90 or 0,0,1,90");
    const Vector3d axis = unit_direction(text.substr(0, comma), "--rotate");
    const auto [c, s] = cosine_and_sine(*degrees);
    Matrix3d cross;
    cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
    return c * Matrix3d::Identity() + s * cross + (1 - c) * axis * axis.transpose();
}

/// The rotation of a quaternion w,x,y,z of any length.
Matrix3d rotation_of_quaternion(const std::string& text) {
    const auto q = numbers_of<double>(text, "--quaternion");
    double largest = 0;
    for (const double x : q)
        largest = std::isfinite(x) ? std::max(largest, std::abs(x)) : std::numeric_limits<double>::infinity();
    if (q.size() != 4 || !(largest > 0) || std::isinf(largest))
        fail_usage(fmt::format("--quaternion is '{}'", printable(text, 60)), "give four finite numbers w,x,y,z, not all zero");
    const Eigen::Quaterniond unit(q[0] / largest, q[1] / largest, q[2] / largest, q[3] / largest);
    return unit.normalized().toRotationMatrix();
}

/// A motion with one linear part about a place that stays where it is.
Motion about(const Vector3d& place, const Matrix3d& rotation, double scale) {
    Motion result{rotation, Vector3d::Zero(), scale};
    result.translation = place - result(place);
    return result;
}

/// Vertices that belong to triangles, or all vertices if there are no triangles.
std::vector<bool> vertices_in_use(const TriangleSoup& soup) {
    std::vector<bool> in_use(soup.points.size(), soup.triangles.empty());
    for (const auto& triangle : soup.triangles)
        for (const Index v : triangle) in_use[v] = true;
    return in_use;
}

/// The places of a moved object to which --about and --centre refer.
class MovedPlaces {
public:
    MovedPlaces(const TriangleSoup& soup, const Motion& motion) : soup_(soup), move_(motion) {
        const std::vector<bool> in_use = vertices_in_use(soup);
        for (std::size_t v = 0; v < in_use.size(); ++v)
            if (in_use[v]) {
                const Vector3d p = place(static_cast<Index>(v));
                low_ = low_.cwiseMin(p);
                high_ = high_.cwiseMax(p);
            }
        if (!(low_.array() <= high_.array()).all()) fail_input("mesh", "has no points", "leave out --about and --centre");
    }
    [[nodiscard]] Vector3d box_centre() const { return low_ + (high_ - low_) / 2; }
    /// The mean of the surface, or the centre of the box for a surface without area.
    [[nodiscard]] Vector3d centroid() const {
        const Vector3d origin = box_centre();
        Vector3d sum = Vector3d::Zero();
        double area = 0;
        for (const auto& [a, b, c] : soup_.triangles) {
            const Vector3d p = place(a) - origin, q = place(b) - origin, r = place(c) - origin;
            const double twice = (q - p).cross(r - p).norm();
            sum += twice * (p + q + r) / 3;
            area += twice;
        }
        return area > 0 ? Vector3d(origin + sum / area) : origin;
    }
    /// The centre of the box, lowered along `up` (a unit vector) to the lowest point.
    [[nodiscard]] Vector3d base(const Vector3d& up) const {
        const Vector3d centre = box_centre();
        const std::vector<bool> in_use = vertices_in_use(soup_);
        double lowest = std::numeric_limits<double>::infinity();
        for (std::size_t v = 0; v < in_use.size(); ++v)
            if (in_use[v]) lowest = std::min(lowest, up.dot(place(static_cast<Index>(v))));
        return centre - up.dot(centre) * up + lowest * up;
    }

private:
    [[nodiscard]] Vector3d place(Index v) const {
        const auto& p = soup_.points[v];
        return move_({p[0], p[1], p[2]});
    }
    const TriangleSoup& soup_;
    PreciseMotion move_;
    Vector3d low_ = Vector3d::Constant(std::numeric_limits<double>::infinity()), high_ = -low_;
};

}  // namespace

void MotionSteps::declare(Parameters& p) {
    p.input_option("matrix", Kind::pose, matrix_,
                   "motion to apply first: 16 numbers row by row (text), JSON that 'mesh register --matrix' or 'mesh move "
                   "--transform' wrote, or an assembly of 'fit'; shear and unequal scales are refused");
    p.options("inverse", inverse_, "apply the inverse of --matrix, to undo a motion");
    p.options("from-unit", from_unit_, "unit of the coordinates of the input; default: the unit that the annotations state",
              Choices(length_units));
    p.options("to-unit", to_unit_, "unit of the coordinates of the output", Choices(length_units));
    p.options("axes", axes_,
              "exchange axes: z-up (if the y axis of the input points up), y-up (if the z axis of the input points up), or the "
              "axes that become x, y and z, like x,z,-y",
              Words{{"z-up", "y-up"}, "three axes like x,z,-y", [](const std::string& text) { (void)matrix_of_axes(text); }});
    p.options("scale", scale_, "factor by which all lengths are multiplied; the unit is unchanged", Range{1e-30, 1e30});
    p.options("mirror", mirror_, "mirror along this axis; triangles are reversed, so that the surface stays oriented outwards",
              direction_words("--mirror"));
    p.options("rotate", rotate_, "axis and angle in degrees, counter-clockwise seen against the axis: z,90 or 0,0,1,90");
    p.options("quaternion", quaternion_, "rotation as a quaternion w,x,y,z");
    p.options("about", about_, "fixed point of --scale, --mirror and --rotate",
              Words{{"origin", "box", "centroid"}, "three numbers like 0,0,1", [](const std::string& text) {
                        if (text != "origin" && text != "box" && text != "centroid") (void)three_numbers(text, "--about");
                    }});
    p.options(
        "centre", centre_,
        "move to the origin: the centre of the bounding box, the centroid of the surface, or the base (the box stands centred "
        "on the ground)",
        Choices{"box", "centroid", "base"});
    up_.declare(p, "upward direction after the rotation, for --centre base; default: that of the annotations, or z");
    p.options("translate", translate_, "vector x,y,z that is added to all coordinates after all other steps, like 10,0,-2.5");
}

void MotionSteps::check() const {
    const bool turns = scale_ || !mirror_.empty() || !rotate_.empty() || !quaternion_.empty();
    if (!matrix_ && !from_unit_ && !to_unit_ && axes_.empty() && !turns && !centre_ && translate_.empty())
        fail_usage("no motion is given",
                   "give --translate, --rotate, --scale, --mirror, --to-unit, --axes, --centre or --matrix");
    if (inverse_ && !matrix_) fail_usage("--inverse without --matrix", "give the file of the matrix to invert");
    if (from_unit_ && !to_unit_) fail_usage("--from-unit without --to-unit", "give the unit of the output as well");
    if (!rotate_.empty()) (void)rotation_of(rotate_);
    if (!quaternion_.empty()) (void)rotation_of_quaternion(quaternion_);
    if (!translate_.empty()) (void)three_numbers(translate_, "--translate");
    if (!rotate_.empty() && !quaternion_.empty()) fail_usage("--rotate and --quaternion", "give one of them");
    if (about_ != "origin" && !turns) fail_usage("--about without --scale, --mirror or --rotate", "give one of these");
    if (up_ && centre_ != "base") fail_usage("--up without --centre base", "give both, or neither");
}

MeshMotion MotionSteps::motion(const TriangleSoup& soup, const std::string& object_name, const AnnotationSet* set) const {
    MeshMotion result;
    if (set != nullptr) result.unit_before = result.unit_after = set->unit;
    if (matrix_) add_matrix(result, object_name);
    if (set != nullptr && !set->unit.empty() && result.unit_before != set->unit)
        fail_input(matrix_.file(),
                   fmt::format("moves an object in {}, and the annotations of {} are in {}", printable(result.unit_before, 20),
                               printable(object_name), printable(set->unit, 20)),
                   "give annotations in this unit; --inverse moves in the other direction");
    if (to_unit_) add_unit(result, object_name, set);
    if (!axes_.empty()) result.motion = Motion{matrix_of_axes(axes_)}.after(result.motion);
    in_file(object_name, [&] {
        add_turn(result, soup);
        if (centre_) add_centre(result, soup, set);
    });
    if (!translate_.empty()) result.motion.translation += three_numbers(translate_, "--translate");
    return result;
}

void MotionSteps::add_matrix(MeshMotion& result, const std::string& object_name) const {
    const std::string name = Path(object_name).stem().string();
    StoredMotion stored = matrix_.load<StoredMotion>([&](const Path& file) { return read_motion(file, name); }, 0, name);
    if (inverse_) {
        stored.motion = stored.motion.inverse();
        std::swap(stored.unit_before, stored.unit_after);
    }
    result.motion = stored.motion;
    result.notes = stored.notes;
    if (stored.unit_before.empty() || stored.unit_after.empty()) return;
    result.unit_before = stored.unit_before;
    result.unit_after = stored.unit_after;
}

void MotionSteps::add_unit(MeshMotion& result, const std::string& object_name, const AnnotationSet* set) const {
    const std::string stated = result.unit_after, from = from_unit_ ? *from_unit_ : stated;
    if (from.empty()) {
        if (set == nullptr) fail_usage("--to-unit without --from-unit", "give the unit of the input as well");
        fail_input(object_name, "its annotations state no unit of length", "give the unit with --from-unit");
    }
    if (!stated.empty() && stated != from)
        fail_input(object_name, fmt::format("its coordinates are in {}, and --from-unit is {}", printable(stated, 20), from),
                   "correct the unit of the annotations ('annotation edit --set-unit'), or --from-unit");
    const auto factor = converted(1, from, *to_unit_);
    if (!factor)
        fail_input(object_name,
                   fmt::format("its annotations are in '{}', which is not a known unit of length", printable(from, 20)),
                   "correct the unit ('annotation edit --set-unit'), or give --scale");
    result.motion = Motion{Matrix3d::Identity(), Vector3d::Zero(), *factor}.after(result.motion);
    if (result.unit_before.empty()) result.unit_before = from;
    result.unit_after = *to_unit_;
}

void MotionSteps::add_turn(MeshMotion& result, const TriangleSoup& soup) const {
    Matrix3d linear = Matrix3d::Identity();
    if (!mirror_.empty()) {
        const Vector3d normal = unit_direction(mirror_, "--mirror");
        linear -= 2 * normal * normal.transpose();
    }
    if (!rotate_.empty()) linear = rotation_of(rotate_) * linear;
    if (!quaternion_.empty()) linear = rotation_of_quaternion(quaternion_) * linear;
    if (linear == Matrix3d::Identity() && !scale_) return;
    const Vector3d place = about_ == "origin"     ? Vector3d(Vector3d::Zero())
                           : about_ == "box"      ? MovedPlaces(soup, result.motion).box_centre()
                           : about_ == "centroid" ? MovedPlaces(soup, result.motion).centroid()
                                                  : three_numbers(about_, "--about");
    result.motion = about(place, linear, scale_.value_or(1)).after(result.motion);
}

void MotionSteps::add_centre(MeshMotion& result, const TriangleSoup& soup, const AnnotationSet* set) const {
    const MovedPlaces places(soup, result.motion);
    result.motion.translation -= *centre_ == "box"        ? places.box_centre()
                                 : *centre_ == "centroid" ? places.centroid()
                                                          : places.base(upward(result.motion, set));
}

Vector3d MotionSteps::upward(const Motion& motion, const AnnotationSet* set) const {
    if (const auto up = up_.value()) return Vector3d((*up)[0], (*up)[1], (*up)[2]).normalized();
    if (set == nullptr || !set->up) return Vector3d::UnitZ();
    const auto& up = *set->up;
    return (motion.rotation * Vector3d(up[0], up[1], up[2])).normalized();
}

}  // namespace ostraka
