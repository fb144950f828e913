// Synthetic heads of terracotta figurines with known moulds: archetypes and casts of the archetypes.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ostraka {

/// Labels of the parts of a head; an index into head_part_names().
enum class HeadPart { face, nose, eyes, mouth, chin, hair, ears, hat, beard, back, neck, stump, body };
/// Names of the parts, in the order of HeadPart.
std::vector<std::string> head_part_names();

/// Proportions of a head 44 mm high, in mm; x points forward, y to the head's left, z up.
struct HeadShape {
    enum class Hat { none, pointed, truncated, turban } hat = Hat::none;  ///< shape of the hat
    bool long_hair = false;                                               ///< true: long hair behind the ears; false: short hair
    double skull_width = 13, skull_depth = 15, skull_height = 16;
    double jaw_width = 10.2, face_length = 15.5, face_depth = 10.5;
    double chin_width = 4.4, chin_forward = 0, chin_height = 5;
    double cheek_height = 16.5, cheek_apart = 6, cheek_size = 3.6;
    double eye_apart = 5.1, eye_height = 23.5, eye_width = 3.1, eye_opening = 1.7, eye_tilt = 4, lid = 0.85;
    double brow_height = 27.5, brow_arch = 1.6, brow_width = 0.95;
    double nose_length = 9.5, nose_forward = 3.4, nose_width = 2.1;
    double mouth_height = 11.2, mouth_width = 4.2, lip = 0.95, smile = 0.7;
    double hair_line = 36, hair_thickness = 2.2, curl = 0.3;
    int curls = 11;
    int lock_ridges = 12;  ///< number of ridges on long hair
    double lock_width = 3.3, lock_forward = 0;
    double ear_height = 21.5, ear_size = 3.6;
    /// Accidental asymmetries of the archetype: lateral shifts of features, mm.
    double nose_skew = 0, mouth_skew = 0, eye_skew = 0;
    /// A low bump on the front at (y, z), with radius and height, mm.
    struct Bump {
        double y, z, radius, height;
    };
    std::vector<Bump> bumps;  ///< accidental bumps on the front
};

struct ArchetypeOptions {
    bool long_hair = false;  ///< true: long hair behind the ears; false: short hair
    bool hand_made = false;  ///< true: hand-formed, with a hat; proportions vary 1.6 times as much
    double difference = 1;   ///< variation between archetypes; 1: standard deviation of proportions of about 8 %
    std::uint64_t seed = 1;  ///< random seed

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};
/// Generates the shape of a random archetype.
HeadShape head_archetype(const ArchetypeOptions& options);

/// Hand-formed features of one cast: the back of the head, a beard, dents.
struct HandWork {
    /// Depth and width, mm, that are added to the skull behind the area shaped by the mould.
    double back_depth = 0, back_width = 0;
    bool beard = false;  ///< true: a beard is added
    double beard_width = 6, beard_length = 7, beard_forward = 2, beard_skew = 0;
    /// A dent on the front at (y, z), with radius and depth, mm.
    struct Dent {
        double y, z, radius, depth;
    };
    std::vector<Dent> dents;  ///< dents on the front
    /// X of the plane behind which the head belongs to the part `back`, mm; negative values are behind the ears.
    double cut_back = 0;
    double cut_tilt = 0, cut_turn = 0;  ///< slopes of this plane
    /// The body of a head, a flared tube, mm; height 0: no body.
    struct Body {
        double height = 0, base = 18, radius = 13, shoulder = 15;
        /// Approximate area of the body's surface.
        [[nodiscard]] double area() const;
    } body;
};

/// The solid of a head, with parts as in head_part_names(). The front is determined by the archetype `shape`, the rest by
/// `work`.
std::unique_ptr<const SyntheticObject> head_object(const HeadShape& shape, const HandWork& work = {});

}  // namespace ostraka
