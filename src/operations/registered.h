// Registers two meshes that are inputs of an operation.
#pragma once

#include "operations/operations.h"

#include "ostraka/registration/mesh_registration.h"

namespace ostraka {

/// Registers `source` to `target`; errors about a mesh name the file of the mesh.
inline MeshRegistration registered(const MeshInput& source, const MeshInput& target,
                                   const MeshRegistrationOptions& options = {}) {
    try {
        return register_mesh(source->mesh, target->mesh, options);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        throw Error(error.kind(), error.where() == "source" ? source.file() : target.file(), error.problem(), error.remedy());
    }
}

}  // namespace ostraka
