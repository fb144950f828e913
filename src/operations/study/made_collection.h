// Shared by the operations that make synthetic collections with known answers: the output folder.
#pragma once

#include "operations/operations.h"

#include "ostraka/collection/objects.h"
#include "ostraka/execution/parallel.h"

#include <string>

namespace ostraka {

/// An operation that makes the objects of a collection in a folder.
struct StudyMake : Operation {
    void declare_folder(Parameters& p, const std::string& help) { p.output("folder", Kind::collection, folder, help); }

    /// Creates the folder, which must not contain objects yet, and makes the objects in parallel.
    template <class MakeOne>
    void make_each(const std::string& phase, std::size_t count, const MakeOne& make_one) const {
        check_new_collection(folder.path());
        folder.open(0, false);
        Progress progress(phase, count);
        parallel_for(count, 1, [&](std::size_t i) {
            make_one(i);
            progress.advance();
        });
    }

    void write(const std::string& name, const Mesh& mesh, const MeshExtras& extras, const Provenance& provenance) const {
        write_mesh(folder.in(name + ".ply"), mesh, extras, {.comment = provenance.to_line()});
    }

    FolderOutput folder;
};

}  // namespace ostraka
