#include "transfer/disjoint_regions.h"

#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

class Settlement {
public:
    Settlement(AnnotatedMeshView source, const Mesh& mesh, std::vector<std::vector<bool>>& selected)
        : source_(source), mesh_(mesh), selected_(selected) {
        for (std::size_t i = 0; i < source.annotations.annotations.size(); ++i)
            if (source.annotations.annotations[i].type == AnnotationType::region && !source.annotations.annotations[i].all)
                regions_.push_back(i);
    }

    void settle(const std::function<const SurfaceSearch&()>& source_search) {
        std::vector<std::uint8_t> claims(mesh_.number_of_faces(), 0);
        parallel_blocks(claims.size(), 65536, [&](std::size_t begin, std::size_t end) {
            for (const std::size_t i : regions_)
                for (std::size_t f = begin; f < std::min(end, selected_[i].size()); ++f)
                    if (selected_[i][f] && claims[f] < 2) ++claims[f];
        });
        const bool parted = part_all();
        for (Index f = 0; f < claims.size(); ++f) {
            if (claims[f] == 1 || (claims[f] == 0 && !parted)) continue;
            if (owners_.empty()) find_owners();
            if (claims[f] == 0) give(f, source_search());
            else share(f, source_search());
        }
    }

private:
    /// Whether each face of the source is in exactly one region.
    [[nodiscard]] bool part_all() const {
        std::vector<bool> taken(source_.mesh.number_of_faces(), false);
        std::size_t count = 0;
        for (const std::size_t i : regions_)
            for (const Index f : source_.annotations.annotations[i].faces) {
                if (taken[f]) return false;
                taken[f] = true;
                ++count;
            }
        return count == taken.size();
    }

    void find_owners() {
        owners_.resize(source_.mesh.number_of_faces());
        for (const std::size_t i : regions_)
            for (const Index f : source_.annotations.annotations[i].faces) owners_[f].push_back(i);
    }

    /// How much of a face each region covers on the source, in sixteenths.
    [[nodiscard]] std::map<std::size_t, int> held(Index face, const SurfaceSearch& source) const {
        std::map<std::size_t, int> parts;
        const Vector normal = area_vector(mesh_, Face(face));
        constexpr int n = 4;
        const auto ask = [&](double a, double b) {
            const Point place = point_at(mesh_, face, {a / (3 * n), b / (3 * n), 1 - (a + b) / (3 * n)});
            auto hit = source.closest_compatible(place, normal, 0, source.diagonal());
            if (!hit) hit = source.closest(place);
            for (const std::size_t i : owners_[hit->face]) ++parts[i];
        };
        // The centroids of the sub-triangles with the orientation of the face, and of those in between.
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                ask(3 * i + 1, 3 * j + 1);
                if (i + j + 1 < n) ask(3 * i + 2, 3 * j + 2);
            }
        return parts;
    }

    [[nodiscard]] bool disjoint(std::size_t a, std::size_t b) {
        const auto [known, fresh] = disjoint_.try_emplace(std::minmax(a, b), true);
        if (fresh) {
            const std::vector<Index>&first = source_.annotations.annotations[a].faces,
                  &second = source_.annotations.annotations[b].faces;
            for (auto i = first.begin(), j = second.begin(); i != first.end() && j != second.end() && known->second;) {
                if (*i == *j) known->second = false;
                else ++(*i < *j ? i : j);
            }
        }
        return known->second;
    }

    void give(Index face, const SurfaceSearch& source) {
        std::size_t best = regions_.front();
        int most = -1;
        for (const auto& [region, parts] : held(face, source))
            if (parts > most) most = parts, best = region;
        if (selected_[best].empty()) selected_[best].resize(mesh_.number_of_faces(), false);
        selected_[best][face] = true;
    }

    void share(Index face, const SurfaceSearch& source) {
        std::vector<std::size_t> claimants;
        for (const std::size_t i : regions_)
            if (!selected_[i].empty() && selected_[i][face]) claimants.push_back(i);
        if (!in_conflict(claimants)) return;
        const auto parts = held(face, source);
        const auto parts_of = [&](std::size_t i) { return parts.contains(i) ? parts.at(i) : 0; };
        std::stable_sort(claimants.begin(), claimants.end(),
                         [&](std::size_t a, std::size_t b) { return parts_of(a) > parts_of(b); });
        std::vector<std::size_t> kept;
        for (const std::size_t i : claimants) {
            const bool free = std::none_of(kept.begin(), kept.end(), [&](std::size_t k) { return disjoint(i, k); });
            if (free) kept.push_back(i);
            else selected_[i][face] = false;
        }
    }

    [[nodiscard]] bool in_conflict(const std::vector<std::size_t>& claimants) {
        for (std::size_t i = 0; i < claimants.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                if (disjoint(claimants[i], claimants[k])) return true;
        return false;
    }

    const AnnotatedMeshView source_;
    const Mesh& mesh_;
    std::vector<std::vector<bool>>& selected_;
    std::vector<std::size_t> regions_;              ///< their positions in the set
    std::vector<std::vector<std::size_t>> owners_;  ///< regions of each face of the source
    std::map<std::pair<std::size_t, std::size_t>, bool> disjoint_;
};

}  // namespace

void keep_disjoint(AnnotatedMeshView source, const std::function<const SurfaceSearch&()>& source_search, const Mesh& mesh,
                   std::vector<std::vector<bool>>& selected) {
    Settlement(source, mesh, selected).settle(source_search);
}

}  // namespace ostraka
