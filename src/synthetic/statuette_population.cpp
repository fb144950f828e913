#include "ostraka/core/angles.h"
#include "ostraka/synthetic/statuettes.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/random.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Sequence of random numbers of one object.
class Draws {
public:
    Draws(std::uint64_t seed, std::uint64_t object) : seed_(seed), next_(object << 20) {}
    double share() { return random_share(seed_, next_++); }
    double normal() {
        const double radius = std::sqrt(-2 * std::log(1 - share()));
        return radius * std::cos(2 * pi * share());
    }
    /// Log-normal with the given median; tails are clamped at 2.5 standard deviations.
    double around(double median, double spread) { return median * std::exp(spread * std::clamp(normal(), -2.5, 2.5)); }
    int among(int choices) { return std::min(static_cast<int>(share() * choices), choices - 1); }

private:
    std::uint64_t seed_, next_;
};

}  // namespace

StatuetteLevel statuette_level(int level) {
    static const StatuetteLevel levels[5] = {
        // ovality, drift, marks, sway, wall noise, off centre
        {{0.006, 8, 0.0030, 0.015, 0.04, 0.05}, {0.036, 90, 0.0150, 0.070, 0.12, 0.15}, 0.25},
        {{0.008, 12, 0.0035, 0.018, 0.045, 0.06}, {0.028, 75, 0.0115, 0.055, 0.11, 0.14}, 0.35},
        {{0.010, 16, 0.0042, 0.021, 0.05, 0.07}, {0.022, 60, 0.0090, 0.044, 0.095, 0.12}, 0.45},
        {{0.012, 20, 0.0050, 0.025, 0.055, 0.08}, {0.018, 45, 0.0075, 0.036, 0.080, 0.11}, 0.50},
        {{0.014, 25, 0.0057, 0.028, 0.06, 0.09}, {0.0165, 35, 0.0066, 0.032, 0.070, 0.10}, 0.55}};
    if (level < 1 || level > 5) fail_usage("there is no level " + std::to_string(level), "use 1 to 5");
    return levels[level - 1];
}

std::vector<StatuetteParameters> draw_population(const PopulationOptions& options) {
    using RequestedInterior = PopulationOptions::Interior;
    using Interior = StatuetteParameters::Interior;
    check_options(options, "population of statuettes");
    const StatuetteLevel level = statuette_level(options.level);
    std::vector<StatuetteParameters> statuettes(static_cast<std::size_t>(options.objects));
    for (std::size_t i = 0; i < statuettes.size(); ++i) {
        Draws draw(options.seed, i);
        StatuetteParameters& statuette = statuettes[i];
        const bool wheel = i % 2 == 0;
        statuette.technique = wheel ? StatuetteParameters::Technique::wheel : StatuetteParameters::Technique::hand;
        const TechniqueLevel& medians = wheel ? level.wheel : level.hand;
        statuette.height = draw.around(200, options.size_spread);
        statuette.base_diameter = draw.around(58, options.size_spread);
        statuette.arm_length = draw.around(82, options.size_spread);
        statuette.head_height = draw.around(44, options.size_spread);
        statuette.ovality = std::min(draw.around(medians.ovality, level.spread), 0.15);
        statuette.ovality_drift = std::min(draw.around(medians.ovality_drift, level.spread), 360.0);
        statuette.finger_marks = std::min(draw.around(medians.finger_marks, level.spread), 0.05);
        statuette.sway = std::min(draw.around(medians.sway, level.spread), 0.2);
        statuette.wall_noise = std::min(draw.around(medians.wall_noise, level.spread), 0.25);
        statuette.off_centre = std::min(draw.around(medians.off_centre, level.spread), 0.4);
        // Features that do not identify the technique by themselves: all thrown bodies are hollow, and half of the others.
        const double hollow = draw.share(), wall = draw.around(5, 0.1), grooves = draw.share();
        statuette.wall = wheel || hollow < 0.5 ? wall : 0;
        statuette.grooves = wheel ? 0.25 * grooves : 0;
        statuette.cavity_seen = options.cavity_seen + (1 - options.cavity_seen) * draw.share();
        const bool may_be_open = draw.share() < 0.5;
        const bool open =
            options.interior == RequestedInterior::mixed ? may_be_open : options.interior == RequestedInterior::open;
        statuette.interior = open ? Interior::open : Interior::closed;
        statuette.scan_noise = options.scan_noise;
        statuette.holes = draw.among(options.holes + 1);
        statuette.hole_radius = 3 + 3 * draw.share();
        statuette.pose = static_cast<StatuetteParameters::Pose>(draw.among(4));
        statuette.hat = static_cast<StatuetteParameters::Hat>(draw.among(3));
        statuette.beard = draw.share() < 0.5;
        statuette.seed = options.seed * 1000003 + i;
        statuette.vertices = options.vertices;
    }
    return statuettes;
}

bool ProportionedOptions::is_fixed(const std::string& size) const {
    return !no_fixed_ratios && std::find(fixed.begin(), fixed.end(), size) != fixed.end();
}

void ProportionedOptions::declare_options(OptionList& list) {
    list("fixed", fixed, "names of the sizes that have fixed ratios to each other, separated by commas",
         Choices(std::vector<std::string>(size_names.begin(), size_names.end())))
        .words();
    list("no-fixed-ratios", no_fixed_ratios, "no fixed ratios of sizes, except the equal lengths of the two arms");
    list("objects", objects, "number of statuettes", Range{1, 100000});
    list("size-deviation", size_deviation, "standard deviation, over the statuettes, of the logarithm of the overall size",
         Range{0, 0.2});
    list("ratio-deviation", ratio_deviation, "standard deviation over the statuettes of the logarithm of ratios that vary",
         Range{0, 0.2});
    list("planted-deviation", planted_deviation, "standard deviation, over the statuettes, of the logarithm of fixed ratios",
         Range{0, 0.2});
    list("scan-noise", scan_noise, "scan noise: standard deviation of the vertex displacements along the normals", Range{0, 0.5},
         "mm");
    list("seed", seed, "random seed from which all objects are made", Range{0, 1e9});
    list("vertices", vertices, "number of vertices of each mesh", Range{4000, 5e6});
}

std::vector<StatuetteParameters> draw_population(const ProportionedOptions& options) {
    check_options(options, "population of statuettes");
    if (!options.no_fixed_ratios && options.fixed.size() < 2)
        fail_usage("--fixed lists a single measure", "give at least two measures");
    PopulationOptions population;
    population.objects = options.objects;
    population.seed = options.seed;
    population.vertices = options.vertices;
    population.scan_noise = options.scan_noise;
    std::vector<StatuetteParameters> statuettes = draw_population(population);
    const double ratio = options.ratio_deviation / std::sqrt(2.0), planted = options.planted_deviation / std::sqrt(2.0);
    constexpr std::array<double, 4> medians{198, 58, 80, 42};
    for (std::size_t i = 0; i < statuettes.size(); ++i) {
        Random random(options.seed, i);
        // Clamped at three standard deviations.
        const auto draw = [&](double deviation) { return deviation * std::clamp(random.normal(), -3.0, 3.0); };
        const double size = draw(options.size_deviation), shared = draw(ratio);
        for (std::size_t k = 0; k < 4; ++k) {
            const double individual = draw(ratio), residual = draw(planted);
            const bool fixed = options.is_fixed(ProportionedOptions::size_names.at(k));
            StatuetteParameters& statuette = statuettes[i];
            double* sizes[]{&statuette.height, &statuette.base_diameter, &statuette.arm_length, &statuette.head_height};
            *sizes[k] = medians.at(k) * std::exp(size + (fixed ? shared + residual : individual));
        }
    }
    return statuettes;
}

}  // namespace ostraka
