// Measures of the objects of a collection: a row an object, a column a measure.
#pragma once

#include "ostraka/core/options.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

struct MeasureColumn {
    std::string name;
    int power = 1;     ///< of the unit of length: 1 for a length, 2 for an area, 3 for a volume; 0 for what is none
    std::string unit;  ///< of the values; for powers of a length set by `unify_units`
};

struct MeasureTable {
    std::vector<std::string> objects;
    std::vector<MeasureColumn> measures;
    Eigen::MatrixXd values;          ///< objects x measures; NaN where a measure is missing
    std::vector<std::string> units;  ///< an object: the unit of its lengths, empty where it is not known
};

/// Lengths of the table in one unit.
struct UnifiedMeasures {
    MeasureTable table;              ///< values of powers of a length in the one unit, where the object's unit is known
    std::vector<bool> comparable;    ///< an object: its lengths may stand beside those of the others
    std::vector<std::string> notes;  ///< what was converted, what cannot be compared, in words
};

/// Converts all lengths to the unit that most objects have (of equally many: mm, cm, m, in, then by name). Units of length are
/// mm, cm, m, um, km, in, ft and their English names; another one can be compared with itself only. Where some objects have a
/// unit, those without, or with one that cannot be converted, are not comparable: their ratios stay good. Where none has a unit
/// all are. Throws Error (usage) where the table's sizes do not fit.
UnifiedMeasures unify_units(const MeasureTable& table);

/// A population of measures with known proportions, for trying the study out. The logarithm of measure j of object i is
/// centre_j + size_i + own_ij, all normal; measures of one group have the same `own` but for what the planted ratio varies.
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
    std::vector<int> groups;  ///< a measure: the group it belongs to, or -1
};
/// Throws Error (usage) for options out of range or groups that need more measures than there are.
SyntheticMeasures make_measures(const SyntheticMeasuresOptions& options = {});

}  // namespace ostraka
