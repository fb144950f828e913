// Measures of the objects of a collection: one row per object, one column per measure.
#pragma once

#include "ostraka/core/options.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

/// Heading of a column of a measure table.
struct MeasureColumn {
    std::string name;  ///< name of the measure
    int power = 1;     ///< exponent of the unit of length: 1 for a length, 2 area, 3 volume; 0 for other quantities
    std::string unit;  ///< unit of the column's values; for lengths, areas and volumes set by `unify_units`
};

/// Table of measures of objects.
struct MeasureTable {
    std::vector<std::string> objects;     ///< names of the objects, one per row
    std::vector<MeasureColumn> measures;  ///< one per column
    Eigen::MatrixXd values;               ///< one row per object, one column per measure; NaN: the measure is missing
    std::vector<std::string> units;       ///< for each object: unit of its lengths; empty if unknown
};

/// A table with all lengths in one unit.
struct UnifiedMeasures {
    MeasureTable table;  ///< lengths, areas and volumes are in the common unit where the object's unit is known
    /// For each object: true if its lengths can be compared with the lengths of other objects.
    std::vector<bool> comparable;
    std::vector<std::string> notes;  ///< messages about converted units and about objects that cannot be compared
};

/// Converts all lengths to the unit that most objects have (ties: mm, cm, m, in, then by name). Units of length are mm, cm, m,
/// um, km, in, ft and their English names; any other unit is comparable only with itself. If some objects have a unit, objects
/// without a unit or with a unit that cannot be converted are not comparable, but their ratios remain valid. If no object has a
/// unit, all objects are comparable. Throws Error (usage) if the sizes of the table do not match.
UnifiedMeasures unify_units(const MeasureTable& table);

/// Options of a synthetic population of measures with known proportions, for testing the study. The logarithm of measure j of
/// object i is the sum of three normally distributed terms: the mean of measure j, the size of object i, and the deviation of
/// measure j in object i. Within an object, all measures of one group have the same deviation, apart from small random
/// differences.
struct SyntheticMeasuresOptions {
    int objects = 40;                 ///< number of objects
    int measures = 8;                 ///< number of measures
    int groups = 2;                   ///< number of groups of measures with fixed proportions
    int group_size = 2;               ///< number of measures in each group
    double ratio_deviation = 0.15;    ///< standard deviation of the logarithm of ratios that are not fixed
    double planted_deviation = 0.03;  ///< standard deviation of the logarithm of fixed ratios
    double size_deviation = 0.15;     ///< standard deviation of the logarithm of the objects' size
    /// The standard deviations of the measures are multiplied by factors from 1 - spread to 1 + spread.
    double spread = 0;
    double missing = 0;      ///< fraction of missing values
    std::uint64_t seed = 1;  ///< random seed

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A synthetic table of measures with its true groups.
struct SyntheticMeasures {
    MeasureTable table;
    std::vector<int> groups;  ///< for each measure: index of its group; -1: in no group
};
/// Generates a synthetic table of measures. Throws Error (usage) if an option is out of range or if the groups together have
/// more measures than the table.
SyntheticMeasures make_measures(const SyntheticMeasuresOptions& options = {});

}  // namespace ostraka
