#include "ostraka/collection/measure_table.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace ostraka {

namespace {

/// The usual name of a unit and its length in metres.
struct LengthUnit {
    std::string name;
    double metres;
};

const std::vector<LengthUnit>& length_units() {
    static const std::vector<LengthUnit> units{{"mm", 1e-3},   {"cm", 1e-2}, {"m", 1},   {"in", 0.0254},
                                               {"ft", 0.3048}, {"um", 1e-6}, {"km", 1e3}};
    return units;
}

std::string usual_name(std::string unit) {
    std::transform(unit.begin(), unit.end(), unit.begin(),
                   [](unsigned char c) { return c < 128 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c); });
    static const std::map<std::string, std::string> names{
        {"millimetre", "mm"},  {"millimetres", "mm"}, {"millimeter", "mm"},  {"millimeters", "mm"}, {"centimetre", "cm"},
        {"centimetres", "cm"}, {"centimeter", "cm"},  {"centimeters", "cm"}, {"metre", "m"},        {"metres", "m"},
        {"meter", "m"},        {"meters", "m"},       {"inch", "in"},        {"inches", "in"},      {"\"", "in"},
        {"foot", "ft"},        {"feet", "ft"},        {"micrometre", "um"},  {"micrometer", "um"},  {"\u00b5m", "um"},
        {"\u03bcm", "um"},     {"kilometre", "km"},   {"kilometer", "km"}};
    const auto usual = names.find(unit);
    return usual == names.end() ? unit : usual->second;
}

std::optional<double> metres(const std::string& unit) {
    for (const LengthUnit& known_unit : length_units())
        if (known_unit.name == unit) return known_unit.metres;
    return std::nullopt;
}

std::string power_of(const std::string& unit, int power) {
    if (unit.empty() || power == 0) return {};
    return power == 1 ? unit : fmt::format("{}^{}", unit, power);
}

}  // namespace

UnifiedMeasures unify_units(const MeasureTable& table) {
    const std::size_t n = table.objects.size();
    if (table.units.size() != n || static_cast<std::size_t>(table.values.rows()) != n ||
        static_cast<std::size_t>(table.values.cols()) != table.measures.size())
        fail_usage(fmt::format("the table of measures has {} rows for {} objects and {} columns for {} measures",
                               table.values.rows(), n, table.values.cols(), table.measures.size()),
                   "give one row and one unit per object, and one column per measure");
    UnifiedMeasures result{table, std::vector<bool>(n, true), {}};
    const bool lengths = std::any_of(table.measures.begin(), table.measures.end(), [](const auto& m) { return m.power != 0; });
    std::map<std::string, std::size_t> counts;
    for (std::string& unit : result.table.units) {
        unit = usual_name(unit);
        if (!unit.empty()) ++counts[unit];
    }
    if (counts.empty() || !lengths) return result;

    std::string common;
    std::size_t maximum = 0;
    for (const LengthUnit& known_unit : length_units())
        if (const auto unit_count = counts.find(known_unit.name); unit_count != counts.end() && unit_count->second > maximum)
            common = known_unit.name, maximum = unit_count->second;
    for (const auto& [unit, count] : counts)
        if (count > maximum) common = unit, maximum = count;

    std::map<std::string, std::size_t> converted, foreign;
    std::size_t unknown = 0;
    for (std::size_t i = 0; i < n; ++i) {
        std::string& unit = result.table.units[i];
        if (unit == common) continue;
        const std::optional<double> unit_length = metres(unit), common_length = metres(common);
        if (unit.empty() || !unit_length || !common_length) {
            result.comparable[i] = false;
            if (unit.empty()) ++unknown;
            else ++foreign[unit];
            continue;
        }
        for (std::size_t j = 0; j < table.measures.size(); ++j)
            result.table.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *=
                std::pow(*unit_length / *common_length, table.measures[j].power);
        ++converted[unit];
        unit = common;
    }
    for (MeasureColumn& column : result.table.measures)
        if (column.power != 0) column.unit = power_of(common, column.power);
    for (const auto& [unit, count] : converted)
        result.notes.push_back(fmt::format("lengths of {} were converted from {} to {}", counted(count, "object"), unit, common));
    if (unknown > 0)
        result.notes.push_back(counted(unknown, "object") +
                               " without a unit: left out of the rows of lengths, but used for ratios");
    for (const auto& [unit, count] : foreign)
        result.notes.push_back(
            fmt::format("{} in '{}', which cannot be converted to {}: left out of the rows of lengths, but used for ratios",
                        counted(count, "object"), unit, common));
    return result;
}

SyntheticMeasures make_measures(const SyntheticMeasuresOptions& options) {
    check_options(options, "synthetic measures");
    if (options.groups * options.group_size > options.measures)
        fail_usage(
            fmt::format("{} groups of {} measures need more than {}", options.groups, options.group_size, options.measures),
            "increase --measures, or reduce --groups or --group-size");
    Random random(options.seed);
    const auto n = static_cast<Eigen::Index>(options.objects), m = static_cast<Eigen::Index>(options.measures);
    SyntheticMeasures synthetic;
    synthetic.table.values.resize(n, m);
    synthetic.table.units.assign(static_cast<std::size_t>(n), "mm");
    // Measures are assigned to groups at random, so that their order carries no information.
    synthetic.groups.assign(static_cast<std::size_t>(m), -1);
    const std::vector<std::size_t> order = random.permutation(static_cast<std::size_t>(m));
    for (int g = 0, next = 0; g < options.groups; ++g)
        for (int k = 0; k < options.group_size; ++k) synthetic.groups[order[static_cast<std::size_t>(next++)]] = g;
    std::vector<double> centre, own;
    for (Eigen::Index j = 0; j < m; ++j) {
        synthetic.table.measures.push_back({"measure " + std::to_string(j + 1), 1, "mm"});
        centre.push_back(std::log(random.uniform(20, 200)));
        own.push_back(options.ratio_deviation / std::sqrt(2.0) * random.uniform(1 - options.spread, 1 + options.spread));
    }
    for (Eigen::Index i = 0; i < n; ++i) {
        synthetic.table.objects.push_back("object " + std::to_string(i + 1));
        const double size = random.normal(0, options.size_deviation);
        std::vector<double> shared(static_cast<std::size_t>(options.groups));
        for (double& value : shared) value = random.normal();
        for (Eigen::Index j = 0; j < m; ++j) {
            const auto at = static_cast<std::size_t>(j);
            const double alone = random.normal(), drawn = random.uniform();
            const double deviation = synthetic.groups[at] < 0 ? own[at] * alone
                                                              : options.ratio_deviation / std::sqrt(2.0) *
                                                                        shared[static_cast<std::size_t>(synthetic.groups[at])] +
                                                                    options.planted_deviation / std::sqrt(2.0) * alone;
            synthetic.table.values(i, j) =
                drawn < options.missing ? std::numeric_limits<double>::quiet_NaN() : std::exp(centre[at] + size + deviation);
        }
    }
    return synthetic;
}

void SyntheticMeasuresOptions::declare_options(OptionList& list) {
    list("objects", objects, "number of objects", Range{1, 100000});
    list("measures", measures, "number of measures", Range{1, 60});
    list("groups", groups, "number of groups of measures; the measures of a group have fixed ratios to each other", Range{0, 30});
    list("group-size", group_size, "number of measures in each group with fixed ratios", Range{2, 60});
    list("ratio-deviation", ratio_deviation, "standard deviation over the statuettes of the logarithm of ratios that vary",
         Range{0, 2});
    list("planted-deviation", planted_deviation, "standard deviation, over the statuettes, of the logarithm of fixed ratios",
         Range{0, 2});
    list("size-deviation", size_deviation, "standard deviation of the logarithm of the objects' common size", Range{0, 2});
    list("spread", spread,
         "spread of the individual deviations of measures: they are multiplied by evenly spaced factors "
         "from 1 - spread to 1 + spread",
         Range{0, 0.95});
    list("missing", missing, "fraction of missing values", Range{0, 0.95});
    list("seed", seed, "random seed", Range{0, 1e18});
}

}  // namespace ostraka
