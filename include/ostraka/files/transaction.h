// Output transactions that span several threads, and protection of inputs that earlier runs wrote as outputs.
#pragma once

#include "ostraka/files/file.h"

namespace ostraka {

/// The innermost transaction open on this thread; null if there is none.
OutputTransaction* current_transaction();
/// Sets the transaction of this thread (null: none) during the lifetime of this object. Threads of a parallel loop use a
/// TransactionScope to write into the transaction of the thread that started the loop.
class TransactionScope {
public:
    explicit TransactionScope(OutputTransaction* transaction);
    ~TransactionScope();
    TransactionScope(const TransactionScope&) = delete;
    TransactionScope& operator=(const TransactionScope&) = delete;

private:
    OutputTransaction* outer_;
};

/// Protects input files of this run: during the lifetime of this object, transactions committed on this thread do not remove
/// these files, even if an earlier run wrote them into a folder of `replace_outputs`.
class ProtectedInputs {
public:
    explicit ProtectedInputs(std::vector<Path> files);
    ~ProtectedInputs();
    ProtectedInputs(const ProtectedInputs&) = delete;
    ProtectedInputs& operator=(const ProtectedInputs&) = delete;

private:
    std::vector<Path> outer_;
};

}  // namespace ostraka
