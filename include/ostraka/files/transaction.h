// Output transactions across threads, and inputs among earlier outputs.
#pragma once

#include "ostraka/files/file.h"

namespace ostraka {

/// The innermost transaction open on this thread, or nullptr.
OutputTransaction* current_transaction();
/// Sets the transaction (or none) of this thread during its lifetime: parallel loops write into the transaction of the thread
/// that starts them.
class TransactionScope {
public:
    explicit TransactionScope(OutputTransaction* transaction);
    ~TransactionScope();
    TransactionScope(const TransactionScope&) = delete;
    TransactionScope& operator=(const TransactionScope&) = delete;

private:
    OutputTransaction* outer_;
};

/// While it lives, transactions committed on this thread do not remove these files, even if an earlier run wrote them into a
/// folder of `replace_outputs`: they are inputs of this run.
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
