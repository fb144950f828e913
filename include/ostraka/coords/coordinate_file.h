// Coordinates on disk: NumPy arrays, and a JSON header that binds them to a mesh and a cage.
#pragma once

#include "ostraka/coords/certificate.h"
#include "ostraka/core/provenance.h"

#include <optional>

namespace ostraka {

/// "weights.npy" has the header "weights.coordinates.json" and, for Green coordinates, its normal weights in
/// "weights.normal.npy", in the same folder. Of sparse coordinates it holds the stored weights, row by row; their columns are in
/// "weights.columns.npy", and where each row begins among them in "weights.rows.npy" (compressed sparse rows).
Path coordinate_header_file(const Path& weights);
Path normal_weights_file(const Path& weights);
Path sparse_columns_file(const Path& weights);
Path sparse_rows_file(const Path& weights);

/// What a header says (doc/schema/coordinates.schema.json).
struct CoordinateHeader {
    std::string kind;
    struct Array {
        std::string file;  ///< name without folder
        std::size_t rows = 0, columns = 0;
        std::string sha256;  ///< of the file's bytes
    };
    Array vertex;
    std::optional<Array> normal;
    /// Of sparse weights, whose array then has one column.
    struct Sparse {
        std::size_t columns = 0;  ///< of the matrix
        Array column, row;        ///< of each weight; where each row begins, and the end
    };
    std::optional<Sparse> sparse;
    struct Bound {
        std::size_t vertices = 0, faces = 0;
        std::string sha256;  ///< mesh_checksum
    };
    Bound mesh, cage;
};

/// Writes the arrays (float64, of places int64, C order) and the header, each atomically. Throws Error (usage) unless the file
/// ends in .npy and the coordinates fit mesh and cage, Error (failure) where a weight is not finite.
void write_coordinates(const Path& weights, const Coordinates& coordinates, const Mesh& mesh, const Mesh& cage,
                       const CoordinateCertificate& certificate, const Provenance& provenance);

/// Throws Error (input) with the file and the remedy if there is no header, it does not fit its schema, its kind is not known, or
/// it has normal weights where its kind has none, or none where it has.
CoordinateHeader read_coordinate_header(const Path& weights);

/// Reads coordinates of this mesh in this cage. Throws Error (input) that says what to do where the header was made for another
/// mesh or cage (checksums of the indexed geometry), arrays were changed since, have another shape, hold numbers that are not
/// finite, or rows that do not sum to 1 within a millionth (with normals also: that do not reproduce their point at rest).
Coordinates read_coordinates(const Path& weights, const Mesh& mesh, const Mesh& cage);

}  // namespace ostraka
