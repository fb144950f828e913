#include "boxes.h"

#include "ostraka/core/error.h"
#include "ostraka/fracture/facets.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/stats/random.h"
#include "ostraka/synthetic/make_mesh.h"
#include "report.h"
#include "shatter.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace ostraka::experiments {

using Eigen::Vector3d;

namespace {

Mesh whole_of(const std::string& source) {
    const std::size_t colon = source.find(':');
    const std::string kind = source.substr(0, colon), rest = colon == std::string::npos ? "" : source.substr(colon + 1);
    if (kind == "pot") {
        PotOptions options;
        options.shape = std::stoull(rest);
        Random random(options.shape, 77);
        options.height = random.uniform(10, 25);
        options.radius = random.uniform(5, 10);
        options.wall = random.uniform(0.35, 0.9);
        return make_pot(options);
    }
    if (kind == "plate" || kind == "stone") {
        // A plate or bar, or a block or boulder.
        Random random(std::stoull(rest), 79);
        MakeOptions options;
        options.vertices = 8000;
        const char* body = random.uniform() < 0.5 ? "box" : kind == "plate" ? "cylinder" : "sphere";
        const double thin = kind == "plate" ? random.uniform(0.08, 0.2) : random.uniform(0.6, 1);
        const Vector3d factors(1, random.uniform(0.6, 1.2), thin);
        Mesh mesh = make_mesh(synthetic_object(body), options).mesh;
        CGAL::Bbox_3 box;
        for (const Vertex v : mesh.vertices()) box += mesh.point(v).bbox();
        const Vector3d extent(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
        for (const Vertex v : mesh.vertices())
            mesh.point(v) = point_of(eigen(mesh.point(v)).cwiseQuotient(extent).cwiseProduct(factors));
        return mesh;
    }
    if (kind == "made") {
        MakeOptions options;
        options.vertices = 8000;
        return make_mesh(synthetic_object(rest), options).mesh;
    }
    return read_mesh(source).mesh;
}

/// Whether each face of a fragment faces another's surface within the distance `reach`.
std::vector<bool> facing(const Mesh& mesh, const std::vector<const SurfaceSearch*>& others, double reach) {
    std::vector<bool> result(mesh.number_of_faces(), false);
    for (const Face f : mesh.faces()) {
        const Vector normal = area_vector(mesh, f);
        const double length = std::sqrt(normal.squared_length());
        if (!(length > 0)) continue;
        for (const SurfaceSearch* other : others)
            if (other->closest_compatible(centroid(mesh, f), -normal / length, 0.5, reach)) result[f] = true;
    }
    return result;
}

}  // namespace

std::vector<Path> fragment_files(const std::string& folder) {
    std::vector<Path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string(), stem = entry.path().stem().string();
        // The vessel's folder also holds two point clouds of other vessels.
        if ((ending == ".obj" || ending == ".ply") && stem.rfind("AL_", 0) != 0 && stem.rfind("CC_", 0) != 0)
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

Box read_box(const std::string& source, int pieces, std::uint64_t seed, FacetChoice facets) {
    Box box;
    box.name = source;
    if (std::filesystem::is_directory(source)) {
        box.name = Path(source).filename().string();
        box.scanned = true;
        const std::vector<Path> files = fragment_files(source);
        FragmentFileOptions reading;
        reading.facets =
            facets == FacetChoice::found ? FragmentFileOptions::FacetSource::automatic : FragmentFileOptions::FacetSource::none;
        CGAL::Bbox_3 bounds;
        double edge = 0;
        for (const Path& file : files) {
            box.fragments.push_back(read_fragment(file, reading).fragment);
            const Mesh& mesh = box.fragments.back().mesh;
            for (const Vertex v : mesh.vertices()) bounds += mesh.point(v).bbox();
            edge = std::max(edge, mean_edge_length(mesh));
        }
        box.diagonal = std::sqrt(std::pow(bounds.xmax() - bounds.xmin(), 2) + std::pow(bounds.ymax() - bounds.ymin(), 2) +
                                 std::pow(bounds.zmax() - bounds.zmin(), 2));
        const bool copied = box.name.rfind("bb_", 0) == 0;
        box.gap = copied ? 1e-4 * box.diagonal : std::max(2 * edge, 0.012 * box.diagonal);
        if (facets == FacetChoice::known) {
            std::vector<SurfaceSearch> searches;
            for (const Fragment& one : box.fragments) searches.emplace_back(one.mesh);
            for (std::size_t k = 0; k < searches.size(); ++k) {
                std::vector<const SurfaceSearch*> others;
                for (std::size_t q = 0; q < searches.size(); ++q)
                    if (q != k) others.push_back(&searches[q]);
                const std::vector<bool> broken = facing(box.fragments[k].mesh, others, box.gap);
                for (const bool one : broken) box.fragments[k].facets.push_back(one ? Facet::fracture : Facet::outer);
            }
        }
    } else {
        const Mesh whole = whole_of(source);
        ShatterOptions breaking;
        breaking.pieces = pieces;
        breaking.seed = seed;
        Random random(seed, 78);
        breaking.roughness = random.uniform(0.008, 0.04);
        const double piece = std::sqrt(surface_area(whole) / pieces) / box_diagonal(whole);  // as a share of the diagonal
        breaking.noise = 0.002 * static_cast<double>(seed % 3) * piece;
        breaking.erosion = 0.0075 * static_cast<double>(seed / 3 % 3) * piece;  // on each side: up to 3 % between two pieces
        // Mating faces have separate vertices and edges, and in one box of four the scans are simplified. With seeds 300 to 399
        // the pieces stay as cut, like published simulated fractures.
        const bool as_cut = seed / 100 == 3;
        const double own_edge = 0.01 * std::pow(2, random.uniform()) * piece;
        const std::uint64_t few = seed % 4 == 3 && !as_cut ? 500 + random.below(1000) : 0;
        if (as_cut) breaking.noise = breaking.erosion = 0;
        else breaking.edge = own_edge;
        box.level = format(", noise %.1f %%, wear %.2f %%", 100 * breaking.noise / piece, 100 * breaking.erosion / piece);
        if (as_cut) box.level += ", as cut";
        if (few > 0) box.level += format(", %llu vertices", static_cast<unsigned long long>(few));
        box.diagonal = box_diagonal(whole);
        box.gap = (0.004 + 2.2 * breaking.erosion + 4 * breaking.noise + (few > 0 ? 0.8 : 0.3) * own_edge) * box.diagonal;
        const SurfaceSearch skin(whole);
        for (Sherd& sherd : shatter(whole, breaking)) {
            if (few > 0) sherd = simplified(sherd, few);
            Fragment fragment;
            fragment.name = std::to_string(box.fragments.size());
            if (facets == FacetChoice::known) {
                // The original side of a face would require a classification of the whole's outside; here all intact faces are
                // outer.
                for (const bool broken : sherd.broken) fragment.facets.push_back(broken ? Facet::fracture : Facet::outer);
                const Facets found = find_facets(sherd.mesh);
                for (std::size_t f = 0; f < fragment.facets.size(); ++f)
                    if (found.shell && !sherd.broken[f] && found.of_face[f] == Facet::inner) fragment.facets[f] = Facet::inner;
            } else {
                fragment.facets = find_facets(sherd.mesh).of_face;
            }
            fragment.mesh = std::move(sherd.mesh);
            box.fragments.push_back(std::move(fragment));
        }
    }
    find_contacts(box);
    return box;
}

void find_contacts(Box& box) {
    const std::size_t n = box.fragments.size();
    std::vector<SurfaceSearch> searches;
    for (const Fragment& one : box.fragments) searches.emplace_back(one.mesh);
    std::vector<double> broken(n, 0);
    std::vector<std::vector<double>> area(n, std::vector<double>(n, 0));
    for (std::size_t k = 0; k < n; ++k) {
        const Mesh& mesh = box.fragments[k].mesh;
        std::vector<bool> any(mesh.number_of_faces(), false);
        for (std::size_t q = 0; q < n; ++q) {
            if (q == k) continue;
            const std::vector<bool> touching = facing(mesh, {&searches[q]}, box.gap);
            for (const Face f : mesh.faces())
                if (touching[f]) area[k][q] += face_area(mesh, f), any[f] = true;
        }
        for (const Face f : mesh.faces())
            if (any[f]) broken[k] += face_area(mesh, f);
    }
    box.contact.assign(n, std::vector<double>(n, 0));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            const double smaller = std::min(broken[i], broken[j]);
            if (smaller > 0) box.contact[i][j] = 0.5 * (area[i][j] + area[j][i]) / smaller;
        }
}

}  // namespace ostraka::experiments
