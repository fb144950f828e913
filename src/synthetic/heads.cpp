#include "ostraka/synthetic/heads.h"

#include "ostraka/stats/random.h"
#include "synthetic/builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ostraka {

using shapes::add_member;
using shapes::turned;

namespace {

constexpr int label(HeadPart part) { return static_cast<int>(part); }

/// Builds a head from the inside out: skull and face first, then features on its front.
class HeadBuilder {
public:
    HeadBuilder(const HeadShape& shape, const HandWork& work)
        : s_(shape),
          w_(work),
          object_(shapes::start_object("head", "head of a figurine", "face, hair, ears, neck", 0, 1500, 2.6)) {}

    std::unique_ptr<const SyntheticObject> build() {
        const std::array<std::array<std::uint8_t, 3>, 13> colours{{{205, 160, 120},
                                                                   {220, 175, 130},
                                                                   {150, 170, 190},
                                                                   {190, 110, 90},
                                                                   {195, 150, 100},
                                                                   {110, 80, 60},
                                                                   {215, 150, 130},
                                                                   {90, 110, 150},
                                                                   {80, 60, 50},
                                                                   {170, 160, 150},
                                                                   {200, 150, 115},
                                                                   {140, 140, 140},
                                                                   {185, 135, 100}}};
        const auto names = head_part_names();
        for (std::size_t i = 0; i < names.size(); ++i) shapes::add_part(*object_, names[i], colours[i]);
        bare_head();
        eyes();
        brows();
        nose();
        mouth();
        if (s_.hat == HeadShape::Hat::none) hair();
        else hat();
        ears();
        if (w_.beard) beard();
        dents();
        bumps();
        if (w_.body.height > 0) body();
        cuts();
        object_->finish();
        return std::move(object_);
    }

private:
    static SolidPose at(const Vector3d& centre, const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity()) {
        return {centre, rotation};
    }
    void add(SolidPointer solid, HeadPart part, double blend) { add_member(*object_, std::move(solid), label(part), blend); }

    /// The largest x of the members so far on the line (y, z).
    double front(double y, double z) {
        if (finished_ != object_->members.size()) object_->finish();
        finished_ = object_->members.size();
        double out = 40, in = 0;
        for (double x = 40; x > -20; x -= 0.5) {
            if (object_->sample({x, y, z}).value < 0) {
                in = x;
                break;
            }
            out = x;
        }
        for (int i = 0; i < 30; ++i) {
            const double middle = (in + out) / 2;
            (object_->sample({middle, y, z}).value < 0 ? in : out) = middle;
        }
        return in;
    }
    Vector3d on(double y, double z, double lift = 0) { return {front(y, z) + lift, y, z}; }

    void bare_head() {
        add(make_ellipsoid(at({-2 - 0.5 * w_.back_depth, 0, 27.5}),
                           {s_.skull_depth + 0.5 * w_.back_depth, s_.skull_width + 0.2 * w_.back_width, s_.skull_height}),
            HeadPart::face, 0);
        add(make_ellipsoid(at({2.5, 0, s_.face_length + 3}), {s_.face_depth, s_.jaw_width, s_.face_length}), HeadPart::face, 7);
        add(make_ellipsoid(at({8.3 + s_.chin_forward, 0, s_.chin_height}), {3.6, s_.chin_width, 3.4}), HeadPart::chin, 5);
        for (const double side : {1.0, -1.0}) {
            add(make_ellipsoid(at({7.2, side * s_.cheek_apart, s_.cheek_height}),
                               {s_.cheek_size + 0.8, s_.cheek_size, s_.cheek_size + 0.6}),
                HeadPart::face, 4);
        }
        add(make_tube({{{-3, 0, 14}, 8.2}, {{-3.5, 0, 5}, 7.6}, {{-4, 0, -3}, 8.2}}), HeadPart::neck, 5);
    }

    void eyes() {
        for (const double side : {1.0, -1.0}) {
            const double y = side * s_.eye_apart, z = s_.eye_height + side * s_.eye_skew;
            const double x = front(y, z);
            const Eigen::Matrix3d rotation =
                turned(-side * s_.eye_tilt, Vector3d::UnitX()) * turned(side * 18, Vector3d::UnitZ());
            // The socket, the eyeball in it, then the lids around it.
            shapes::carve(*object_,
                          make_ellipsoid(at({x + 1.1, y, z + 0.4}, rotation), {2.4, s_.eye_width + 1.3, s_.eye_opening + 2}), -1,
                          2.5);
            add(make_ellipsoid(at({x - 1.9, y, z}, rotation), {2.3, s_.eye_width * 0.92, s_.eye_opening * 1.1}), HeadPart::eyes,
                0.6);
            for (const double lid_side : {1.0, -1.0}) {
                std::vector<Bead> beads;
                for (int k = 0; k <= 8; ++k) {
                    const double u = -1 + 0.25 * k;
                    const double rise = lid_side * s_.eye_opening * (1 - u * u) * (lid_side > 0 ? 1.15 : 0.85);
                    const Vector3d offset =
                        turned(side * -s_.eye_tilt, Vector3d::UnitX()) * Vector3d(0, u * s_.eye_width * 1.1, rise);
                    const double yy = y + offset.y(), zz = z + offset.z();
                    beads.push_back({on(yy, zz, -0.25 * s_.lid), s_.lid * (lid_side > 0 ? 1.1 : 0.85)});
                }
                add(make_tube(beads), HeadPart::eyes, 0.5);
            }
        }
    }

    void brows() {
        for (const double side : {1.0, -1.0}) {
            std::vector<Bead> beads;
            for (int k = 0; k <= 8; ++k) {
                const double u = k / 8.0, y = side * (1.6 + u * (s_.eye_apart + s_.eye_width - 0.6));
                const double z = s_.brow_height + side * s_.eye_skew + s_.brow_arch * (4 * u * (1 - u) - 0.9 * u);
                beads.push_back({on(y, z, -0.35 * s_.brow_width), s_.brow_width * (1.1 - 0.35 * u)});
            }
            add(make_tube(beads), HeadPart::eyes, 1.2);
        }
    }

    void nose() {
        const double top = s_.brow_height - 0.3, tip = top - s_.nose_length, lean = s_.nose_skew;
        const Vector3d root = on(0, top, -0.9), tip_place = on(lean, tip + 0.8, s_.nose_forward - s_.nose_width * 0.75);
        add(make_tube({{root, 1.5},
                       {0.5 * (root + tip_place) + Vector3d(0.2, 0.4 * lean, 0), 0.5 * (1.5 + s_.nose_width) - 0.15},
                       {tip_place, s_.nose_width}}),
            HeadPart::nose, 1.6);
        for (const double side : {1.0, -1.0}) {
            const double y = lean + side * s_.nose_width;
            add(make_ellipsoid(at({tip_place.x() - 1.3, y, tip + 0.2}), {1.7, 1.25, 1.3}), HeadPart::nose, 0.9);
        }
    }

    void mouth() {
        const double z = s_.mouth_height, skew = s_.mouth_skew;
        for (const double lip_side : {1.0, -1.0}) {
            std::vector<Bead> beads;
            for (int k = 0; k <= 8; ++k) {
                const double u = -1 + 0.25 * k, width = lip_side > 0 ? s_.mouth_width : 0.8 * s_.mouth_width;
                const double y = skew + u * width;
                const double dip = lip_side > 0 && k == 4 ? -0.25 : 0;
                const double height =
                    z + s_.smile * u * u * (lip_side > 0 ? 1 : 0.7) + lip_side * (1 - 0.8 * u * u) * s_.lip * 0.95 + dip;
                beads.push_back({on(y, height, -0.2 * s_.lip), s_.lip * (1 - 0.45 * u * u) * (lip_side > 0 ? 0.95 : 1.1)});
            }
            add(make_tube(beads), HeadPart::mouth, 0.35);
        }
    }

    /// A ring of curls along the hair line, the hair cap behind it, and side locks for long hair.
    void hair() {
        add(make_ellipsoid(
                at({-3.6 - 0.5 * w_.back_depth, 0, 29.5}),
                {s_.skull_depth + 0.4 + 0.5 * w_.back_depth, s_.skull_width + s_.hair_thickness - 0.6 + 0.2 * w_.back_width,
                 s_.skull_height - 0.5 + 0.3 * s_.hair_thickness}),
            HeadPart::hair, 0.8);
        fringe(0, 1);
        fringe(2.6, 0.9);
        if (!s_.long_hair) return;
        add(make_ellipsoid(at({-7, 0, 14}), {8, s_.skull_width + 0.6, 20}), HeadPart::hair, 2.5);
        for (const double side : {1.0, -1.0}) {
            std::vector<Bead> beads;
            const int ridges = s_.lock_ridges;
            for (int k = 0; k <= ridges; ++k) {
                const double u = static_cast<double>(k) / ridges;
                const double radius = s_.lock_width + 0.3 * s_.hair_thickness - 0.4 + (k % 2 == 0 ? s_.curl : -s_.curl);
                // Down to the shoulders, close to the jaw and the neck.
                const double out = s_.skull_width + 0.2, y = out - (out - 9.6) * std::pow(u, 1.2);
                beads.push_back({{0.5 + s_.lock_forward - 2.5 * u, side * y, 25 - 28 * u}, radius});
            }
            add(make_tube(beads), HeadPart::hair, 1.2);
        }
    }

    void fringe(double back, double size) {
        const int count = 2 * s_.curls;
        std::vector<Bead> beads;
        for (int k = 0; k <= count; ++k) {
            const double angle = (-1 + 2.0 * k / count) * 1.75;  // from ear to ear, over the forehead
            const double y = (s_.skull_width - 0.2) * std::sin(angle) / std::sin(1.57);
            const double z = 22.5 + (s_.hair_line - 22.5 + 0.5 * back) * std::pow(std::max(std::cos(angle * 0.9), 0.0), 0.7);
            // Beyond the skull the line runs down its side.
            const double surface_x = std::max(front(std::clamp(y, -s_.skull_width + 0.4, s_.skull_width - 0.4), z), -1.5);
            const double radius = size * (s_.hair_thickness * 0.75 + (k % 2 == 0 ? s_.curl : -s_.curl));
            beads.push_back({{surface_x - back - 0.3, y, z + 0.25 * back}, radius});
        }
        add(make_tube(beads), HeadPart::hair, 0.6);
    }

    /// Clear of the brows, also where the hat tilts forward.
    [[nodiscard]] double hat_rim() const { return std::max(s_.hair_line - 3, s_.brow_height + s_.brow_arch + 4.5); }

    void hat() {
        using Profile = std::vector<Eigen::Vector2d>;
        const double r = s_.skull_width + s_.hair_thickness + 0.5, rim = hat_rim();
        Profile profile;
        if (s_.hat == HeadShape::Hat::pointed)
            profile = {{0, 0}, {r - 1, 0}, {r + 1.2, 2}, {r - 0.8, 5}, {0.62 * r, 16}, {0.3 * r, 26}, {0, 31}};
        else if (s_.hat == HeadShape::Hat::truncated)
            profile = {{0, 0}, {r - 1, 0}, {r + 1, 2}, {r - 1, 5}, {0.72 * r, 13}, {0.62 * r, 16.5}, {0, 17.5}};
        else profile = {{0, 0}, {r - 1, 0}, {r + 3, 4}, {r + 1.5, 9}, {0.7 * r, 13}, {0, 14}};
        const double lean = 3 * s_.nose_skew;
        add(make_revolved(at({-2.5, 0, rim}, turned(-6, Vector3d::UnitY()) * turned(lean, Vector3d::UnitX())), profile),
            HeadPart::hat, 1.2);
    }

    void ears() {
        const bool hat = s_.hat != HeadShape::Hat::none;
        // Below the rim of a hat.
        const double height = hat ? std::min(s_.ear_height, hat_rim() - 2.5 - s_.ear_size) : s_.ear_height;
        for (const double side : {1.0, -1.0}) {
            const double out = s_.long_hair ? 1.6 : 0.3;
            const Vector3d centre(1.2, side * (s_.skull_width + out), height);
            const Eigen::Matrix3d rotation = turned(side * 22, Vector3d::UnitZ()) * turned(-8, Vector3d::UnitY());
            add(make_ellipsoid(at(centre, rotation), {0.62 * s_.ear_size, 2.1, s_.ear_size}), HeadPart::ears, 1.4);
            if (hat) continue;
            // A shallow hollow that does not pierce the ear.
            shapes::carve(*object_,
                          make_ellipsoid(at(centre + Vector3d(0.6, side * 2.1, 0.5), rotation),
                                         {0.36 * s_.ear_size, 1.0, 0.5 * s_.ear_size}),
                          -1, 0.7);
        }
    }

    void beard() {
        const double y = w_.beard_skew, top = 7.5;
        const Vector3d root = on(y, top, -1.5);
        for (const double spread : {-0.45, 0.0, 0.45}) {
            const double length = w_.beard_length * (1 - std::abs(spread) * 0.6);
            add(make_tube({{root + Vector3d(-std::abs(spread) * 2, spread * w_.beard_width, 0), 0.42 * w_.beard_width},
                           {root + Vector3d(0.6 * w_.beard_forward, 0.3 * y + 0.9 * spread * w_.beard_width, -0.5 * length),
                            0.45 * w_.beard_width},
                           {root + Vector3d(w_.beard_forward, 0.5 * y + 0.5 * spread * w_.beard_width, -length),
                            0.28 * w_.beard_width}}),
                HeadPart::beard, 2);
        }
    }

    void dents() {
        for (const auto& dent : w_.dents) {
            const double x = front(dent.y, dent.z), ball = (dent.radius * dent.radius / dent.depth + dent.depth) / 2;
            shapes::carve(*object_, make_ellipsoid(at({x + ball - dent.depth, dent.y, dent.z}), Vector3d::Constant(ball)), -1,
                          0.3);
        }
    }

    void bumps() {
        for (const auto& bump : s_.bumps) {
            const int part = object_->part(on(bump.y, bump.z));
            object_->reliefs.push_back({on(bump.y, bump.z), Vector3d::UnitX(), bump.radius, bump.height, 0, 1, part});
        }
    }

    void body() {
        const auto& b = w_.body;
        const double foot = -b.height;
        const std::vector<Eigen::Vector2d> profile{{0, foot},
                                                   {0.8 * b.base, foot},
                                                   {b.base, foot + 0.03 * b.height},
                                                   {0.5 * (b.base + b.radius), foot + 0.15 * b.height},
                                                   {b.radius, foot + 0.4 * b.height},
                                                   {b.shoulder, -0.3 * b.height},
                                                   {0.85 * b.shoulder, -0.18 * b.height},
                                                   {8.5, -8},
                                                   {4, -4},
                                                   {0, -2}};
        add(make_revolved(at({-4, 0, 0}), profile), HeadPart::body, 1);
    }

    void cuts() {
        for (std::size_t part = 0; part < object_->parts.size(); ++part) {
            const int part_label = static_cast<int>(part);
            if (part_label == label(HeadPart::back) || part_label == label(HeadPart::stump) ||
                part_label == label(HeadPart::body))
                continue;
            const HandWork w = w_;
            object_->cuts.push_back({part_label, label(HeadPart::back), [w](const Vector3d& p) {
                                         return p.x() - w.cut_back - w.cut_tilt * (p.z() - 20) - w.cut_turn * p.y();
                                     }});
        }
        for (std::size_t part = 0; part < object_->parts.size(); ++part)
            if (static_cast<int>(part) != label(HeadPart::body))
                object_->cuts.push_back(
                    {static_cast<int>(part), label(HeadPart::stump), [](const Vector3d& p) { return p.z() + 4 + 0.15 * p.x(); }});
    }

    const HeadShape& s_;
    const HandWork& w_;
    std::unique_ptr<SyntheticObject> object_;
    std::size_t finished_ = 0;  ///< number of members included in the object's boxes
};

}  // namespace

std::vector<std::string> head_part_names() {
    return {"face", "nose", "eyes", "mouth", "chin", "hair", "ears", "hat", "beard", "back", "neck", "stump", "body"};
}

double HandWork::Body::area() const { return height > 0 ? 2 * std::numbers::pi * radius * height + 4 * base * base : 0; }

HeadShape head_archetype(const ArchetypeOptions& options) {
    check_options(options, "head");
    Random draw(options.seed, 71);
    HeadShape s;
    s.long_hair = options.long_hair;
    const double spread = 0.08 * options.difference * (options.hand_made ? 1.6 : 1);
    // Proportions are clamped to 2.5 standard deviations, so that every head can be built.
    const auto vary = [&](double& value, double factor = 1) {
        value *= 1 + factor * spread * std::clamp(draw.normal(), -2.5, 2.5);
    };
    vary(s.skull_width, 0.5), vary(s.skull_depth, 0.5), vary(s.skull_height, 0.35);
    vary(s.jaw_width, 0.7), vary(s.face_length, 0.35), vary(s.face_depth, 0.4);
    vary(s.chin_width), vary(s.chin_height, 0.6);
    s.chin_forward = 10 * spread * std::clamp(draw.normal(), -2.0, 2.0);
    vary(s.cheek_height, 0.5), vary(s.cheek_apart, 0.7), vary(s.cheek_size, 0.7);
    vary(s.eye_apart, 0.7), vary(s.eye_height, 0.35), vary(s.eye_width), vary(s.eye_opening, 1.5), vary(s.eye_tilt, 5);
    vary(s.lid);
    s.brow_height = s.eye_height + 4 * (1 + 1.5 * spread * std::clamp(draw.normal(), -2.0, 2.0));
    vary(s.brow_arch, 3), vary(s.brow_width);
    vary(s.nose_length, 0.8), vary(s.nose_forward, 1.5), vary(s.nose_width, 1.2);
    vary(s.mouth_height, 0.6), vary(s.mouth_width, 1.2), vary(s.lip, 1.2), vary(s.smile, 5);
    vary(s.hair_line, 0.35), vary(s.hair_thickness, 1.2), vary(s.curl, 2), vary(s.ear_height, 0.5), vary(s.ear_size, 1.2);
    s.curls += static_cast<int>(draw.below(5)) - 2;
    s.lock_ridges += static_cast<int>(draw.below(7)) - 3;
    s.lock_width *= 1 + 0.8 * spread * std::clamp(draw.normal(), -1.5, 1.5);
    s.lock_forward = 8 * spread * std::clamp(draw.normal(), -2.0, 2.0);
    const double skew = 5 * spread;
    s.nose_skew = skew * std::clamp(draw.normal(), -2.0, 2.0);
    s.mouth_skew = skew * std::clamp(draw.normal(), -2.0, 2.0);
    s.eye_skew = 0.7 * skew * std::clamp(draw.normal(), -2.0, 2.0);
    for (int i = 0; i < 8; ++i) {
        const double y = draw.uniform(-7, 7), z = draw.uniform(6, 33), radius = draw.uniform(2, 4);
        s.bumps.push_back({y, z, radius, std::clamp(4 * spread * draw.normal(), -0.7, 0.7)});
    }
    if (options.hand_made) {
        constexpr HeadShape::Hat kinds[] = {HeadShape::Hat::pointed, HeadShape::Hat::truncated, HeadShape::Hat::turban};
        s.hat = kinds[draw.below(3)];
    }
    return s;
}

std::unique_ptr<const SyntheticObject> head_object(const HeadShape& shape, const HandWork& work) {
    return HeadBuilder(shape, work).build();
}

void ArchetypeOptions::declare_options(OptionList& list) {
    list("long-hair", long_hair, "long locks behind the ears, instead of a cap of short hair", Anything{});
    list("hand-made", hand_made, "make a hand-formed head: with larger variation, and with a hat", Anything{});
    list("difference", difference, "difference between the archetypes of moulds: 1 means that proportions vary by about 8 %",
         Range{0, 3});
    list("archetype-seed", seed, "random seed of the proportions of the archetype", Range{0, 9007199254740992.0});
}

}  // namespace ostraka
