#include "boxes.h"

#include "shatter.h"

#include "ostraka/core/error.h"
#include "ostraka/fracture/facets.h"
#include "ostraka/reconstruction/fragment_file.h"

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
    if (kind != "plate" && kind != "stone") return read_or_make(source, 8000);
    // A plate or bar, or a block or boulder.
    Random random(std::stoull(rest), 79);
    const char* body = random.uniform() < 0.5 ? "box" : kind == "plate" ? "cylinder" : "sphere";
    const double thin = kind == "plate" ? random.uniform(0.08, 0.2) : random.uniform(0.6, 1);
    const Vector3d factors(1, random.uniform(0.6, 1.2), thin);
    const Mesh mesh = made_mesh(body, 8000);
    const CGAL::Bbox_3 box = bounding_box(mesh);
    const Vector3d extent(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
    return warped(mesh, [&](const Vector3d& p) { return p.cwiseQuotient(extent).cwiseProduct(factors); });
}

std::vector<SurfaceSearch> searches_of(const std::vector<Fragment>& fragments) {
    std::vector<SurfaceSearch> searches;
    for (const Fragment& fragment : fragments) searches.emplace_back(fragment.mesh);
    return searches;
}

const auto any_hit = [](const SurfaceHit&, const Point&, const Vector&) { return true; };

Box scanned_box(const std::string& folder, FacetChoice facets) {
    FragmentLayout layout = read_layout(folder, facets);
    Box box;
    box.name = layout.name;
    box.diagonal = layout.diagonal;
    box.gap = layout.copied ? 1e-4 * box.diagonal : std::max(2 * layout.edge, 0.012 * box.diagonal);
    box.fragments = std::move(layout.fragments);
    if (facets == FacetChoice::found) return box;
    const std::vector<SurfaceSearch> searches = searches_of(box.fragments);
    for (std::size_t k = 0; k < searches.size(); ++k)
        for (const bool broken : facing(box.fragments[k].mesh, others_than(k, searches), box.gap, any_hit))
            box.fragments[k].facets.push_back(broken ? Facet::fracture : Facet::outer);
    return box;
}

Box broken_box(const std::string& source, int pieces, std::uint64_t seed, FacetChoice facets) {
    Box box;
    box.name = source;
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
    const double piece_edge = 0.01 * std::pow(2, random.uniform()) * piece;
    const std::uint64_t few = seed % 4 == 3 && !as_cut ? 500 + random.below(1000) : 0;
    if (as_cut) breaking.noise = breaking.erosion = 0;
    else breaking.edge = piece_edge;
    box.level = fmt::format(", noise {:.1f} %, wear {:.2f} %", 100 * breaking.noise / piece, 100 * breaking.erosion / piece);
    if (as_cut) box.level += ", as cut";
    if (few > 0) box.level += fmt::format(", {} vertices", few);
    box.diagonal = box_diagonal(whole);
    box.gap = (0.004 + 2.2 * breaking.erosion + 4 * breaking.noise + (few > 0 ? 0.8 : 0.3) * piece_edge) * box.diagonal;
    for (Sherd& sherd : shatter(whole, breaking)) {
        if (few > 0) sherd = ostraka::simplified(sherd, few);
        Fragment& fragment = box.fragments.emplace_back();
        fragment.name = std::to_string(box.fragments.size() - 1);
        const Facets found = find_facets(sherd.mesh);
        fragment.facets = found.of_face;
        // Known fracture; the original side of an intact face would require a classification of the whole's outside.
        for (std::size_t f = 0; facets == FacetChoice::known && f < fragment.facets.size(); ++f)
            fragment.facets[f] = sherd.broken[f]                                   ? Facet::fracture
                                 : found.shell && found.of_face[f] == Facet::inner ? Facet::inner
                                                                                   : Facet::outer;
        fragment.mesh = std::move(sherd.mesh);
    }
    return box;
}

void find_contacts(Box& box) {
    const std::size_t n = box.fragments.size();
    const std::vector<SurfaceSearch> searches = searches_of(box.fragments);
    std::vector<double> broken(n, 0);
    std::vector<std::vector<double>> area(n, std::vector<double>(n, 0));
    for (std::size_t k = 0; k < n; ++k) {
        const Mesh& mesh = box.fragments[k].mesh;
        std::vector<bool> any(mesh.number_of_faces(), false);
        for (std::size_t q = 0; q < n; ++q) {
            if (q == k) continue;
            const std::vector<bool> touching = facing(mesh, {&searches[q]}, box.gap, any_hit);
            for (const Face f : mesh.faces())
                if (touching[f]) area[k][q] += face_area(mesh, f), any[f] = true;
        }
        for (const Face f : mesh.faces())
            if (any[f]) broken[k] += face_area(mesh, f);
    }
    box.contact.assign(n, std::vector<double>(n, 0));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
            if (const double smaller = std::min(broken[i], broken[j]); smaller > 0)
                box.contact[i][j] = 0.5 * (area[i][j] + area[j][i]) / smaller;
}

}  // namespace

Motion move_at_random(Fragment& fragment, Random& random, double far) {
    Motion motion;
    Eigen::Vector4d q(random.normal(), random.normal(), random.normal(), random.normal());
    q.normalize();
    motion.rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    motion.translation = far * normal_vector(random);
    fragment.mesh = moved(fragment.mesh, motion);
    return motion;
}

std::vector<const Fragment*> pointers_to(const std::vector<Fragment>& fragments) {
    std::vector<const Fragment*> pointers;
    for (const Fragment& fragment : fragments) pointers.push_back(&fragment);
    return pointers;
}

std::vector<const SurfaceSearch*> others_than(std::size_t k, const std::vector<SurfaceSearch>& searches) {
    std::vector<const SurfaceSearch*> others;
    for (std::size_t q = 0; q < searches.size(); ++q)
        if (q != k) others.push_back(&searches[q]);
    return others;
}

double diagonal_of(const std::vector<Fragment>& fragments) {
    CGAL::Bbox_3 bounds;
    for (const Fragment& fragment : fragments) bounds += bounding_box(fragment.mesh);
    return Vector3d(bounds.xmax() - bounds.xmin(), bounds.ymax() - bounds.ymin(), bounds.zmax() - bounds.zmin()).norm();
}

FragmentLayout read_layout(const std::string& folder, FacetChoice facets) {
    std::vector<Path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string(), stem = entry.path().stem().string();
        // The vessel's folder also holds two point clouds of other vessels.
        if ((ending == ".obj" || ending == ".ply") && !stem.starts_with("AL_") && !stem.starts_with("CC_"))
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    FragmentFileOptions reading;
    using Source = FragmentFileOptions::FacetSource;
    reading.facets = facets == FacetChoice::found ? Source::automatic : Source::none;
    FragmentLayout layout;
    layout.name = Path(folder).filename().string();
    layout.copied = layout.name.starts_with("bb_");
    for (const Path& file : files) {
        layout.fragments.push_back(read_fragment(file, reading).fragment);
        layout.edge = std::max(layout.edge, mean_edge_length(layout.fragments.back().mesh));
    }
    layout.diagonal = diagonal_of(layout.fragments);
    return layout;
}

void for_each_box(const BoxOptions& options, const std::function<FacetChoice(std::uint64_t)>& facets,
                  const std::function<void(Box&&, std::uint64_t)>& take) {
    std::uint64_t seed = options.seed;
    for (const std::string& source : options.boxes) {
        ++seed;
        std::optional<Box> box;
        try {
            box = std::filesystem::is_directory(source) ? scanned_box(source, facets(seed))
                                                        : broken_box(source, options.pieces, seed, facets(seed));
            find_contacts(*box);
        } catch (const Error& error) {
            fmt::print(stderr, "{} is left out: {}\n", source, error.what());
            continue;
        }
        take(std::move(*box), seed);
    }
}

}  // namespace ostraka::experiments
