// Measures of the objects of a collection: one row per object, one column per measure.
#pragma once

#include "ostraka/core/options.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

struct MeasureColumn {
    std::string name;
    int power = 1;     ///< power of the unit of length: 1 length, 2 area, 3 volume; 0 for other quantities
    std::string unit;  ///< unit of the values; for powers of a length set by `unify_units`
};

struct MeasureTable {
    std::vector<std::string> objects;
    std::vector<MeasureColumn> measures;
    Eigen::MatrixXd values;          ///< objects x measures; NaN where a measure is missing
    std::vector<std::string> units;  ///< one per object: unit of its lengths; empty if unknown
};

/// A table with all lengths in one unit.
struct UnifiedMeasures {
    MeasureTable table;              ///< lengths, areas and volumes are in the common unit where the object's unit is known
    std::vector<bool> comparable;    ///< one per object: whether its lengths can be compared with those of the others
    std::vector<std::string> notes;  ///< messages on what was converted and what cannot be compared
};

/// Converts all lengths to the unit that most objects have (ties: mm, cm, m, in, then by name). Units of length are mm, cm, m,
/// um, km, in, ft and their English names; any other unit is comparable only with itself. If some objects have a unit, objects
/// without one or with one that cannot be converted are not comparable, but their ratios remain valid. If no object has a unit,
/// all are comparable. Throws Error (usage) if the sizes of the table do not match.
UnifiedMeasures unify_units(const MeasureTable& table);

/// Options of a synthetic population of measures with known proportions, for testing the study. The logarithm of measure j of
/// object i is centre_j + size_i + own_ij, all normally distributed; measures of one group share the same `own` except for the
/// variation of the planted ratio.
struct SyntheticMeasuresOptions {
    int objects = 40;
    int measures = 8;
    int groups = 2;
    int group_size = 2;
    double ratio_deviation = 0.15;
    double planted_deviation = 0.03;
    double size_deviation = 0.15;
    double spread = 0;
    double missing = 0;
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

struct SyntheticMeasures {
    MeasureTable table;
    std::vector<int> groups;  ///< one per measure: its group, or -1
};
/// Generates the measures. Throws Error (usage) if an option is out of range or if the groups need more measures than there
/// are.
SyntheticMeasures make_measures(const SyntheticMeasuresOptions& options = {});

}  // namespace ostraka
