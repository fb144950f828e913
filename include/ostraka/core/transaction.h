// Transactions of outputs over several threads, and inputs among earlier outputs.
#pragma once

#include "ostraka/core/file.h"

namespace ostraka {

/// The innermost transaction that is open on this thread, or none.
OutputTransaction* current_transaction();
/// Makes it (or none) that of this thread as long as it lives: parallel loops write into the transaction of who starts them.
class TransactionScope {
public:
    explicit TransactionScope(OutputTransaction* transaction);
    ~TransactionScope();
    TransactionScope(const TransactionScope&) = delete;
    TransactionScope& operator=(const TransactionScope&) = delete;

private:
    OutputTransaction* outer_;
};

/// While it lives, no transaction that this thread commits removes these files, even where an earlier run wrote them into a
/// folder of `replace_outputs`: they are inputs of this one.
class KeptFiles {
public:
    explicit KeptFiles(std::vector<Path> files);
    ~KeptFiles();
    KeptFiles(const KeptFiles&) = delete;
    KeptFiles& operator=(const KeptFiles&) = delete;

private:
    std::vector<Path> outer_;
};

}  // namespace ostraka
