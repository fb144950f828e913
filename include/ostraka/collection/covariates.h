// Tables of covariates: factors and numbers that describe the specimens of a study.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/stats/permuted_model.h"

#include <string>
#include <vector>

namespace ostraka {

/// A table with one row per specimen.
struct CovariateTable {
    std::string where;                                 ///< name of the file, for messages
    std::vector<std::string> specimens;                ///< first column: names of the specimens
    std::vector<std::string> columns;                  ///< names of the other columns
    std::vector<std::vector<std::string>> cells = {};  ///< for each specimen, its cells; empty or NA: unknown
};

/// Reads a CSV table whose first row names the columns. Throws Error (input) for a table without rows, rows of different length,
/// and a specimen with two rows.
CovariateTable read_covariates(const Path& file);

/// Variables of the specimens of a study.
struct SpecimenVariables {
    std::vector<ModelVariable> variables;  ///< one per column, for the specimens that are kept
    std::vector<std::size_t> kept;         ///< indices of the specimens with all needed values
    /// Specimens that were left out, with the reason.
    std::vector<std::pair<std::string, std::string>> left_out;
    [[nodiscard]] const ModelVariable& named(const std::string& name) const;  ///< throws Error (usage) with all names
};

/// The columns `needed` of the table (empty: all) for these specimens. A column is a number if all its cells are, and it is not
/// in `factors`. A specimen without a row or with an unknown value is left out. Throws Error (usage) for a column that does not
/// exist, Error (input) if no specimen is left.
SpecimenVariables variables_of(const CovariateTable& table, const std::vector<std::string>& specimens,
                               const std::vector<std::string>& needed, const std::vector<std::string>& factors = {});

}  // namespace ostraka
