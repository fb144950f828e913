#include "ostraka/coords/coordinate_file.h"

#include "ostraka/core/error.h"
#include "ostraka/core/json_build.h"
#include "ostraka/core/npy.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/safe_path.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr const char* schema = "coordinates";
/// Largest deviation of a sum of weights from 1, and of a point at rest (relative to the cage's diagonal).
constexpr double max_off = 1e-6;
constexpr const char* anew = "compute them anew with 'ostraka cage weights'";

void check_name(const Path& weights) {
    if (extension(weights) != ".npy")
        throw Error(ErrorKind::usage, weights.string(), "is no name for a NumPy array", "end it in .npy");
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
    const auto place = [&](const Path& file, const std::vector<std::int64_t>& list) {
        return array_json(file, list.size(), 1, write_npy(file, list, {list.size()}), allocator);
    };
    add_members(document, allocator, "vertex",
                array_json(weights, count, 1, write_npy(weights, std::span(matrix.valuePtr(), count), {count}), allocator));
    add_members(document, allocator, "sparse",
                json_object(allocator, "columns", static_cast<std::size_t>(matrix.cols()), "column",
                            place(sparse_columns_file(weights), columns), "row", place(sparse_rows_file(weights), begins)));
}

CoordinateHeader::Array array_of(const JsonValue& value) {
    return {value["file"].GetString(), static_cast<std::size_t>(value["rows"].GetUint64()),
            static_cast<std::size_t>(value["columns"].GetUint64()), value["sha256"].GetString()};
}
CoordinateHeader::Bound bound_of(const JsonValue& value) {
    return {static_cast<std::size_t>(value["vertices"].GetUint64()), static_cast<std::size_t>(value["faces"].GetUint64()),
            value["sha256"].GetString()};
}

void check_bound(const Path& header, const std::string& what, const CoordinateHeader::Bound& bound, const Mesh& mesh) {
    if (bound.vertices != mesh.number_of_vertices() || bound.faces != mesh.number_of_faces())
        fail_input(header.string(),
                   "the weights were computed for another " + what + ", of " + std::to_string(bound.vertices) + " vertices and " +
                       std::to_string(bound.faces) + " faces instead of " + std::to_string(mesh.number_of_vertices()) + " and " +
                       std::to_string(mesh.number_of_faces()),
                   std::string("give that ") + what + ", or " + anew);
    if (bound.sha256 != mesh_checksum(mesh))
        fail_input(header.string(),
                   "the weights were computed for another " + what + " (its checksum differs, the numbers of its elements agree)",
                   std::string("give that ") + what + ", or " + anew);
}

/// The bytes of an array, checked against the checksum in the header.
std::string read_bound(const Path& folder, const CoordinateHeader::Array& array) {
    const Path file = folder / array.file;
    std::string bytes = read_file(file);
    if (sha256(bytes) != array.sha256)
        fail_input(file.string(), "is another file than its header was written for (its checksum differs)", anew);
    return bytes;
}

WeightMatrix read_array(const Path& folder, const CoordinateHeader::Array& array, std::size_t rows, std::size_t columns) {
    const Path file = folder / array.file;
    const std::string bytes = read_file(file), where = file.string();
    const NpyView view = view_npy(bytes, where);
    if (view.shape.size() != 2 || view.rows() != rows || view.columns() != columns)
        fail_input(where,
                   "has " + std::to_string(view.rows()) + " rows and " + std::to_string(view.columns()) + " columns, not " +
                       std::to_string(rows) + " and " + std::to_string(columns),
                   anew);
    if (view.type != "<f8") fail_input(where, "is not of little-endian float64", anew);
    check_cancelled();
    WeightMatrix matrix(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    view.copy_to(matrix.data());
    check_cancelled();
    for (Eigen::Index i = 0; i < matrix.size(); ++i)
        if (!std::isfinite(matrix.data()[i])) fail_input(where, "weight " + std::to_string(i) + " is not finite", anew);
    check_cancelled();
    if (sha256(bytes) != array.sha256)
        fail_input(where, "is another file than its header was written for (its checksum differs)", anew);
    check_cancelled();
    return matrix;
}

SparseWeights read_sparse(const Path& folder, const CoordinateHeader& header, std::size_t rows, std::size_t columns) {
    const auto list = [&](const CoordinateHeader::Array& array, std::size_t count, auto number) {
        const std::string bytes = read_bound(folder, array), where = (folder / array.file).string();
        const NpyView view = view_npy(bytes, where);
        if (view.shape.size() != 1 || view.rows() != count)
            fail_input(where, "does not hold " + std::to_string(count) + " numbers in a row", anew);
        std::vector<decltype(number)> values(count);
        view.copy_to(values.data());
        return values;
    };
    const std::string where = (folder / header.vertex.file).string();
    if (header.sparse->columns != columns)
        fail_input(where,
                   "has weights of " + std::to_string(header.sparse->columns) + " cage vertices, not " + std::to_string(columns),
                   anew);
    const std::vector<double> values = list(header.vertex, header.vertex.rows, double{});
    const std::vector<std::int64_t> column = list(header.sparse->column, values.size(), std::int64_t{});
    const std::vector<std::int64_t> begin = list(header.sparse->row, rows + 1, std::int64_t{});
    if (begin.front() != 0 || begin.back() != static_cast<std::int64_t>(values.size()) ||
        !std::is_sorted(begin.begin(), begin.end()))
        fail_input((folder / header.sparse->row.file).string(), "its rows do not begin one after the other", anew);
    SparseWeights matrix(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    matrix.reserve(static_cast<Eigen::Index>(values.size()));
    for (std::size_t r = 0; r < rows; ++r) {
        matrix.startVec(static_cast<Eigen::Index>(r));
        for (auto i = static_cast<std::size_t>(begin[r]); i < static_cast<std::size_t>(begin[r + 1]); ++i) {
            const bool first = i == static_cast<std::size_t>(begin[r]);
            if (column[i] < 0 || column[i] >= static_cast<std::int64_t>(columns) || (!first && column[i] <= column[i - 1]))
                fail_input((folder / header.sparse->column.file).string(),
                           "the columns of row " + std::to_string(r) + " are not ascending and within the cage", anew);
            if (!std::isfinite(values[i])) fail_input(where, "weight " + std::to_string(i) + " is not finite", anew);
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
        if (!(std::isfinite(size) && std::fabs(sum - 1) <= max_off * size))
            fail_input(file.string(), "the weights of row " + std::to_string(i) + " do not sum to 1", anew);
    }
}

/// Checks that weights and normal weights reproduce each point at rest; this is the only check on the values of normal weights.
void check_rest(const Path& file, const Coordinates& coordinates, const Mesh& mesh, const Mesh& cage) {
    const std::vector<Point> rest = deformed(coordinates, cage, points_of(cage));
    const double maximum = max_off * box_diagonal(cage);
    for (const Vertex v : mesh.vertices()) {
        const Vector off = rest[v] - mesh.point(v);
        if (!(std::max({std::fabs(off.x()), std::fabs(off.y()), std::fabs(off.z())}) <= maximum))
            fail_input(file.string(), "the weights of row " + std::to_string(v) + " move their point of the mesh at rest", anew);
    }
}

/// Checks that the header has normal weights exactly if its kind has a normal term.
void check_kind(const Path& file, const CoordinateHeader& header) {
    const std::vector<std::string> known = coordinate_kinds();
    if (std::find(known.begin(), known.end(), header.kind) == known.end())
        fail_input(file.string(), "coordinates of the kind '" + header.kind + "' are not known", anew);
    const bool normals = coordinate_kind(header.kind).with_normals;
    if (normals && !header.normal)
        fail_input(file.string(), header.kind + " coordinates need normal weights, and it names none (member 'normal')", anew);
    if (!normals && header.normal)
        fail_input(file.string(), header.kind + " coordinates have no normal weights, but it names some (member 'normal')", anew);
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
        fail_usage("the coordinates do not fit the mesh and the cage", "give those that they were computed for");
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
        fail_input(weights.string(), "has no header " + file.filename().string() + " beside it that says what it belongs to",
                   anew);
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
        fail_input(file.string(), "sparse weights are those of version 2, and it has the other version", anew);
    header.mesh = bound_of(document["mesh"]);
    header.cage = bound_of(document["cage"]);
    check_kind(file, header);
    // Array names must be the standard ones: a header may only refer to the files beside it.
    const auto check = [&](const CoordinateHeader::Array& array, const Path& expected) {
        if (array.file != expected.filename().string())
            fail_input(file.string(), "speaks of the array '" + array.file + "' instead of " + expected.filename().string(),
                       "give the files their old names, or compute them anew");
        if (!is_memory(expected) && !is_inside(expected, file.parent_path()))
            fail_input(expected.string(), "is a link that leads out of the folder", "copy the array there, or compute it anew");
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
