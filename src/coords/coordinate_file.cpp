#include "ostraka/coords/coordinate_file.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/npy.h"
#include "ostraka/files/safe_path.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr const char* schema = "coordinates";
/// Largest deviation of a sum of weights from 1, and of a point at rest (relative to the cage's diagonal).
constexpr double max_deviation = 1e-6;
constexpr const char* recompute = "compute the weights again with 'ostraka cage weights'";

void check_name(const Path& weights) {
    if (extension(weights) != ".npy")
        throw Error(ErrorKind::usage, weights.string(), "is not a name for a NumPy array", "use the extension .npy");
}

JsonValue bound_json(const Mesh& mesh, JsonAllocator& allocator) {
    return json_object(allocator, "vertices", mesh.number_of_vertices(), "faces", mesh.number_of_faces(), "sha256",
                       mesh_checksum(mesh));
}

JsonValue array_json(const Path& file, std::size_t rows, std::size_t columns, const std::string& checksum,
                     JsonAllocator& allocator) {
    return json_object(allocator, "file", file.filename().string(), "rows", rows, "columns", columns, "sha256", checksum);
}

JsonValue write_array(const Path& file, const WeightMatrix& matrix, JsonAllocator& allocator) {
    const auto rows = static_cast<std::size_t>(matrix.rows()), columns = static_cast<std::size_t>(matrix.cols());
    if (!matrix.allFinite()) throw Error(ErrorKind::failure, file.string(), "a weight is not finite");
    const std::string checksum = write_npy(file, std::span(matrix.data(), rows * columns), {rows, columns});
    return array_json(file, rows, columns, checksum, allocator);
}

/// Writes the three arrays of sparse weights and adds them to the header.
void write_sparse(const Path& weights, const SparseWeights& matrix, Json& document, JsonAllocator& allocator) {
    const auto count = static_cast<std::size_t>(matrix.nonZeros()), rows = static_cast<std::size_t>(matrix.rows());
    const std::vector<std::int64_t> columns(matrix.innerIndexPtr(), matrix.innerIndexPtr() + count),
        begins(matrix.outerIndexPtr(), matrix.outerIndexPtr() + rows + 1);
    for (std::size_t i = 0; i < count; ++i)
        if (!std::isfinite(matrix.valuePtr()[i])) throw Error(ErrorKind::failure, weights.string(), "a weight is not finite");
    const auto write_indices = [&](const Path& file, const std::vector<std::int64_t>& values) {
        return array_json(file, values.size(), 1, write_npy(file, values, {values.size()}), allocator);
    };
    add_members(document, allocator, "vertex",
                array_json(weights, count, 1, write_npy(weights, std::span(matrix.valuePtr(), count), {count}), allocator));
    add_members(document, allocator, "sparse",
                json_object(allocator, "columns", static_cast<std::size_t>(matrix.cols()), "column",
                            write_indices(sparse_columns_file(weights), columns), "row",
                            write_indices(sparse_rows_file(weights), begins)));
}

CoordinateHeader::Array array_of(const JsonValue& value) {
    return {value["file"].GetString(), static_cast<std::size_t>(value["rows"].GetUint64()),
            static_cast<std::size_t>(value["columns"].GetUint64()), value["sha256"].GetString()};
}
CoordinateHeader::Bound bound_of(const JsonValue& value) {
    return {static_cast<std::size_t>(value["vertices"].GetUint64()), static_cast<std::size_t>(value["faces"].GetUint64()),
            value["sha256"].GetString()};
}

void check_bound(const Path& header, const std::string& object_name, const CoordinateHeader::Bound& bound, const Mesh& mesh) {
    if (bound.vertices != mesh.number_of_vertices() || bound.faces != mesh.number_of_faces())
        fail_input(header.string(),
                   fmt::format("the weights were computed for another {}, with {} vertices and {} faces instead of {} and {}",
                               object_name, bound.vertices, bound.faces, mesh.number_of_vertices(), mesh.number_of_faces()),
                   fmt::format("give that {}, or {}", object_name, recompute));
    if (bound.sha256 != mesh_checksum(mesh))
        fail_input(
            header.string(),
            fmt::format("the weights were computed for another {} (its checksum differs, the numbers of its elements agree)",
                        object_name),
            fmt::format("give that {}, or {}", object_name, recompute));
}

/// The bytes of an array, checked against the checksum in the header.
std::string read_bound(const Path& folder, const CoordinateHeader::Array& array) {
    const Path file = folder / array.file;
    std::string bytes = read_file(file);
    if (sha256(bytes) != array.sha256)
        fail_input(file.string(), "is not the file that its header was written for (its checksum differs)", recompute);
    return bytes;
}

WeightMatrix read_array(const Path& folder, const CoordinateHeader::Array& array, std::size_t rows, std::size_t columns) {
    const Path file = folder / array.file;
    const std::string bytes = read_file(file), where = file.string();
    const NpyView view = view_npy(bytes, where);
    if (view.shape.size() != 2 || view.rows() != rows || view.columns() != columns)
        fail_input(where, fmt::format("has {} rows and {} columns, not {} and {}", view.rows(), view.columns(), rows, columns),
                   recompute);
    if (view.type != "<f8") fail_input(where, "does not contain little-endian float64 numbers", recompute);
    check_cancelled();
    WeightMatrix matrix(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    view.copy_to(matrix.data());
    check_cancelled();
    for (Eigen::Index i = 0; i < matrix.size(); ++i)
        if (!std::isfinite(matrix.data()[i])) fail_input(where, fmt::format("weight {} is not finite", i), recompute);
    check_cancelled();
    if (sha256(bytes) != array.sha256)
        fail_input(where, "is not the file that its header was written for (its checksum differs)", recompute);
    check_cancelled();
    return matrix;
}

SparseWeights read_sparse(const Path& folder, const CoordinateHeader& header, std::size_t rows, std::size_t columns) {
    const auto read_list = [&](const CoordinateHeader::Array& array, std::size_t count, auto number) {
        const std::string bytes = read_bound(folder, array), where = (folder / array.file).string();
        const NpyView view = view_npy(bytes, where);
        if (view.shape.size() != 1 || view.rows() != count)
            fail_input(where, fmt::format("is not an array of {} numbers", count), recompute);
        std::vector<decltype(number)> values(count);
        view.copy_to(values.data());
        return values;
    };
    const std::string where = (folder / header.vertex.file).string();
    if (header.sparse->columns != columns)
        fail_input(where, fmt::format("has weights for {} cage vertices, not {}", header.sparse->columns, columns), recompute);
    const std::vector<double> values = read_list(header.vertex, header.vertex.rows, double{});
    const std::vector<std::int64_t> column = read_list(header.sparse->column, values.size(), std::int64_t{});
    const std::vector<std::int64_t> begin = read_list(header.sparse->row, rows + 1, std::int64_t{});
    if (begin.front() != 0 || begin.back() != static_cast<std::int64_t>(values.size()) ||
        !std::is_sorted(begin.begin(), begin.end()))
        fail_input((folder / header.sparse->row.file).string(), "the starts of its rows are not in ascending order", recompute);
    SparseWeights matrix(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    matrix.reserve(static_cast<Eigen::Index>(values.size()));
    for (std::size_t r = 0; r < rows; ++r) {
        matrix.startVec(static_cast<Eigen::Index>(r));
        for (auto i = static_cast<std::size_t>(begin[r]); i < static_cast<std::size_t>(begin[r + 1]); ++i) {
            const bool first = i == static_cast<std::size_t>(begin[r]);
            if (column[i] < 0 || column[i] >= static_cast<std::int64_t>(columns) || (!first && column[i] <= column[i - 1]))
                fail_input((folder / header.sparse->column.file).string(),
                           fmt::format("the columns of row {} are not ascending or not within the cage", r), recompute);
            if (!std::isfinite(values[i])) fail_input(where, fmt::format("weight {} is not finite", i), recompute);
            matrix.insertBack(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(column[i])) = values[i];
        }
    }
    matrix.finalize();
    return matrix;
}

/// Checks that the weights of each point sum to one; computed rows deviate by far less than the tolerance of 1e-6.
void check_sums(const Path& file, const WeightMatrix& W) {
    for (Eigen::Index i = 0; i < W.rows(); ++i) {
        double sum = 0, size = 0;
        for (Eigen::Index j = 0; j < W.cols(); ++j) {
            sum += W(i, j);
            size += std::fabs(W(i, j));
        }
        if (!(std::isfinite(size) && std::fabs(sum - 1) <= max_deviation * size))
            fail_input(file.string(), fmt::format("the weights of row {} do not sum to 1", i), recompute);
    }
}

/// Checks that weights and normal weights reproduce each point at rest; this is the only check on the values of normal weights.
void check_rest(const Path& file, const Coordinates& coordinates, const Mesh& mesh, const Mesh& cage) {
    const std::vector<Point> rest = deformed(coordinates, cage, points_of(cage));
    const double maximum = max_deviation * box_diagonal(cage);
    for (const Vertex v : mesh.vertices()) {
        const Vector displacement = rest[v] - mesh.point(v);
        if (!(std::max({std::fabs(displacement.x()), std::fabs(displacement.y()), std::fabs(displacement.z())}) <= maximum))
            fail_input(file.string(),
                       fmt::format("the weights of row {} do not reproduce their point of the mesh at rest", v.idx()), recompute);
    }
}

/// Checks that the header has normal weights exactly if its kind has a normal term.
void check_kind(const Path& file, const CoordinateHeader& header) {
    const std::vector<std::string> kinds = coordinate_kinds();
    if (std::find(kinds.begin(), kinds.end(), header.kind) == kinds.end())
        fail_input(file.string(), fmt::format("the kind of coordinates '{}' is unknown", header.kind), recompute);
    const bool normals = coordinate_kind(header.kind).with_normals;
    if (normals && !header.normal)
        fail_input(file.string(), header.kind + " coordinates need normal weights, but the header names none (member 'normal')",
                   recompute);
    if (!normals && header.normal)
        fail_input(file.string(),
                   header.kind + " coordinates have no normal weights, but the header names some (member 'normal')", recompute);
}

}  // namespace

Path coordinate_header_file(const Path& weights) { return Path(weights).replace_extension(".coordinates.json"); }
Path normal_weights_file(const Path& weights) { return Path(weights).replace_extension(".normal.npy"); }
Path sparse_columns_file(const Path& weights) { return Path(weights).replace_extension(".columns.npy"); }
Path sparse_rows_file(const Path& weights) { return Path(weights).replace_extension(".rows.npy"); }

void write_coordinates(const Path& weights, const Coordinates& coordinates, const Mesh& mesh, const Mesh& cage,
                       const CoordinateCertificate& certificate, const Provenance& provenance) {
    check_name(weights);
    const WeightMatrix &W = coordinates.vertex, &Q = coordinates.normal;
    const auto rows = static_cast<Eigen::Index>(mesh.number_of_vertices());
    if (W.rows() != rows || W.cols() != static_cast<Eigen::Index>(cage.number_of_vertices()) ||
        (coordinates.has_normals() && (Q.rows() != rows || Q.cols() != static_cast<Eigen::Index>(cage.number_of_faces()))))
        fail_usage("the coordinates do not fit the mesh and the cage", "give the mesh and the cage that they were computed for");
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "format", "ostraka-coordinates", "version", coordinates.is_sparse() ? 2 : 1, "kind",
                coordinates.kind);
    if (coordinates.is_sparse()) write_sparse(weights, coordinates.sparse, document, allocator);
    else add_members(document, allocator, "vertex", write_array(weights, W, allocator));
    if (coordinates.has_normals())
        add_member(document, "normal", write_array(normal_weights_file(weights), Q, allocator), allocator);
    add_members(document, allocator, "mesh", bound_json(mesh, allocator), "cage", bound_json(cage, allocator), "certificate",
                to_json(certificate, allocator), "provenance", provenance.to_json(allocator));
    write_json(coordinate_header_file(weights), document);
}

CoordinateHeader read_coordinate_header(const Path& weights) {
    check_name(weights);
    const Path file = coordinate_header_file(weights);
    if (!file_exists(file))
        fail_input(weights.string(),
                   fmt::format("has no header {} in its folder that specifies its mesh and its cage", file.filename().string()),
                   recompute);
    const Json document = read_json(file);
    validate(document, schema, file.string());
    CoordinateHeader header;
    header.kind = document["kind"].GetString();
    header.vertex = array_of(document["vertex"]);
    if (const JsonValue* normal = find_member(document, "normal")) header.normal = array_of(*normal);
    if (const JsonValue* sparse = find_member(document, "sparse"))
        header.sparse = {static_cast<std::size_t>((*sparse)["columns"].GetUint64()), array_of((*sparse)["column"]),
                         array_of((*sparse)["row"])};
    if (header.sparse.has_value() != (document["version"].GetInt() == 2))
        fail_input(file.string(), "sparse weights require version 2 of the header, dense weights version 1", recompute);
    header.mesh = bound_of(document["mesh"]);
    header.cage = bound_of(document["cage"]);
    check_kind(file, header);
    // Array names must be the standard ones: a header may only refer to the files beside it.
    const auto check = [&](const CoordinateHeader::Array& array, const Path& expected) {
        if (array.file != expected.filename().string())
            fail_input(file.string(), fmt::format("names the array '{}' instead of {}", array.file, expected.filename().string()),
                       "give the files their original names, or compute the weights again");
        if (!is_memory(expected) && !is_inside(expected, file.parent_path()))
            fail_input(expected.string(), "is a link that leads out of the folder",
                       "copy the array into the folder, or compute the weights again");
    };
    check(header.vertex, weights);
    if (header.normal) check(*header.normal, normal_weights_file(weights));
    if (header.sparse) {
        check(header.sparse->column, sparse_columns_file(weights));
        check(header.sparse->row, sparse_rows_file(weights));
    }
    return header;
}

Coordinates read_coordinates(const Path& weights, const Mesh& mesh, const Mesh& cage) {
    const CoordinateHeader header = read_coordinate_header(weights);
    const Path file = coordinate_header_file(weights);
    check_bound(file, "mesh", header.mesh, mesh);
    check_bound(file, "cage", header.cage, cage);
    Coordinates result;
    result.kind = header.kind;
    if (header.sparse) {
        result.sparse = read_sparse(weights.parent_path(), header, mesh.number_of_vertices(), cage.number_of_vertices());
        result.vertex = result.sparse;
    } else {
        result.vertex = read_array(weights.parent_path(), header.vertex, mesh.number_of_vertices(), cage.number_of_vertices());
    }
    if (header.normal)
        result.normal = read_array(weights.parent_path(), *header.normal, mesh.number_of_vertices(), cage.number_of_faces());
    check_sums(weights, result.vertex);
    if (result.has_normals()) check_rest(weights, result, mesh, cage);
    return result;
}

}  // namespace ostraka
