// Coordinate files: NumPy arrays with a JSON header that binds them to one mesh and one cage.
#pragma once

#include "ostraka/coords/certificate.h"
#include "ostraka/files/provenance.h"

#include <optional>

namespace ostraka {

/// The files that belong to "weights.npy" are in the same folder: the header "weights.coordinates.json" and, for Green
/// coordinates, the normal weights in "weights.normal.npy". Sparse coordinates are stored as compressed sparse rows:
/// "weights.npy" holds the stored weights row by row, "weights.columns.npy" their columns, and "weights.rows.npy" the start of
/// each row.
Path coordinate_header_file(const Path& weights);  ///< "weights.coordinates.json" for "weights.npy"
Path normal_weights_file(const Path& weights);     ///< "weights.normal.npy" for "weights.npy"
Path sparse_columns_file(const Path& weights);     ///< "weights.columns.npy" for "weights.npy"
Path sparse_rows_file(const Path& weights);        ///< "weights.rows.npy" for "weights.npy"

/// Content of the header of a coordinate file (doc/schema/coordinates.schema.json).
struct CoordinateHeader {
    std::string kind;  ///< kind of coordinates
    struct Array {
        std::string file;                   ///< file name without folder
        std::size_t rows = 0, columns = 0;  ///< size of the array
        std::string sha256;                 ///< checksum of the file's bytes
    };
    Array vertex;                 ///< the vertex weights
    std::optional<Array> normal;  ///< the normal weights; none for kinds without a normal term
    /// Arrays of sparse weights; the array `vertex` then has one column.
    struct Sparse {
        std::size_t columns = 0;  ///< number of columns of the weight matrix
        /// For each stored weight: its column; for each row: index of its first weight, followed by the end of the last row.
        Array column, row;
    };
    std::optional<Sparse> sparse;  ///< none for dense weights
    struct Bound {
        std::size_t vertices = 0, faces = 0;  ///< numbers of vertices and faces
        std::string sha256;                   ///< checksum of the mesh (mesh_checksum)
    };
    Bound mesh, cage;  ///< the mesh and the cage for which the coordinates were computed
};

/// Writes the arrays of coordinates (C order; float64, indices int64) and the header, each file atomically. Throws Error (usage)
/// unless the file name ends in .npy and the coordinates match mesh and cage, Error (failure) for a weight that is not finite.
void write_coordinates(const Path& weights, const Coordinates& coordinates, const Mesh& mesh, const Mesh& cage,
                       const CoordinateCertificate& certificate, const Provenance& provenance);

/// Reads the header of a coordinate file. Throws Error (input) with the file and the remedy if there is no header, the header
/// does not match its schema, the kind is unknown, or normal weights are present or missing contrary to the kind.
CoordinateHeader read_coordinate_header(const Path& weights);

/// Reads coordinates of this mesh in this cage. Throws Error (input) with the remedy if the header belongs to another mesh or
/// cage (checksums of the indexed geometry), if the arrays were changed after writing or have another shape, if a number is not
/// finite, or if a row does not sum to 1 within 1e-6 (with normal weights also: if a row does not reproduce its point from the
/// undeformed cage).
Coordinates read_coordinates(const Path& weights, const Mesh& mesh, const Mesh& cage);

}  // namespace ostraka
