// Combinations of defects introduced into closed meshes, and the number that repair removes.
#include "harness.h"

#include "ostraka/core/error.h"
#include "ostraka/io/repair.h"
#include "ostraka/stats/random.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka::experiments {

namespace {

struct DefectOptions {
    std::vector<std::string> meshes;
    int combinations = 20;
    std::uint64_t seed = 1;
    std::string csv;
    void declare_options(OptionList& list) {
        list("meshes", meshes, "closed meshes; others are left out").positional().required();
        list("combinations", combinations, "number of combinations of defects per mesh", Range{1, 100000});
        list("seed", seed, "random seed of the defects");
        list("csv", csv, "file for the raw rows");
    }
};

/// The defects; combinations are bit masks.
constexpr const char* defect_names[]{"equal duplicates", "opposite duplicates", "flips", "cuts", "T-junctions", "jitter"};
constexpr int equal = 1, opposite = 2, flips = 4, cuts = 8, junctions = 16, jitter = 32, all_defects = 63;

/// A random number of triangles, at most about 2 %.
std::size_t some(const TriangleSoup& soup, Random& random) {
    return 1 + random.below(std::max<std::size_t>(1, soup.triangles.size() / 50));
}

void duplicate(TriangleSoup& soup, Random& random, bool turned) {
    const std::size_t count = soup.triangles.size();
    for (std::size_t left = some(soup, random); left > 0; --left) {
        auto t = soup.triangles[random.below(count)];
        if (turned) std::swap(t[1], t[2]);
        soup.triangles.push_back(t);
    }
}

/// Detaches random patches: their border vertices are duplicated.
void cut(TriangleSoup& soup, Random& random) {
    const std::size_t patches = 1 + random.below(4);
    for (std::size_t patch = 0; patch < patches; ++patch) {
        std::vector<std::uint8_t> inside(soup.points.size(), 0), chosen(soup.triangles.size(), 0);
        for (const Index v : soup.triangles[random.below(chosen.size())]) inside[v] = 1;
        for (std::size_t ring = 1 + random.below(6); ring > 0; --ring) {
            for (std::size_t t = 0; t < chosen.size(); ++t)
                for (const Index v : soup.triangles[t])
                    if (inside[v] != 0) chosen[t] = 1;
            for (std::size_t t = 0; t < chosen.size(); ++t)
                if (chosen[t] != 0)
                    for (const Index v : soup.triangles[t]) inside[v] = 1;
        }
        std::map<Index, Index> copies;
        for (std::size_t t = 0; t < chosen.size(); ++t) {
            if (chosen[t] == 0) continue;
            for (Index& v : soup.triangles[t]) {
                const auto [at, fresh] = copies.emplace(v, static_cast<Index>(soup.points.size()));
                if (fresh) soup.points.push_back(std::array(soup.points[v]));
                v = at->second;
            }
        }
    }
}

/// Splits sides of triangles with a vertex that the neighbouring triangles lack.
void split_sides(TriangleSoup& soup, Random& random) {
    const std::size_t count = soup.triangles.size();
    for (std::size_t left = some(soup, random); left > 0; --left) {
        const std::size_t t = random.below(count), k = random.below(3);
        const auto corners = soup.triangles[t];
        const Index a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
        const double at = random.uniform(0.2, 0.8);
        const auto m = static_cast<Index>(soup.points.size());
        std::array<double, 3> place{};
        for (std::size_t i = 0; i < 3; ++i) place[i] = (1 - at) * soup.points[a][i] + at * soup.points[b][i];
        soup.points.push_back(place);
        soup.triangles[t] = {a, m, c};
        soup.triangles.push_back({m, b, c});
    }
}

/// Triangles with separate vertices, slightly displaced.
TriangleSoup jittered(const TriangleSoup& soup, double distance, Random& random) {
    TriangleSoup loose;
    for (const auto& t : soup.triangles) {
        const auto first = static_cast<Index>(loose.points.size());
        for (const Index v : t) {
            auto p = soup.points[v];
            for (double& x : p) x += random.uniform(-distance, distance);
            loose.points.push_back(p);
        }
        loose.triangles.push_back({first, first + 1, first + 2});
    }
    return loose;
}

TriangleSoup with_defects(TriangleSoup soup, int defects, double diagonal, Random& random) {
    if ((defects & cuts) != 0) cut(soup, random);
    if ((defects & junctions) != 0) split_sides(soup, random);
    if ((defects & equal) != 0) duplicate(soup, random, false);
    if ((defects & opposite) != 0) duplicate(soup, random, true);
    if ((defects & flips) != 0)
        for (std::size_t left = some(soup, random); left > 0; --left) {
            auto& t = soup.triangles[random.below(soup.triangles.size())];
            std::swap(t[1], t[2]);
        }
    if ((defects & jitter) != 0) soup = jittered(soup, 1e-5 * diagonal, random);
    return soup;
}

std::string names_of(int defects) {
    std::string names;
    for (std::size_t d = 0; d < std::size(defect_names); ++d)
        if ((defects >> d & 1) != 0) names += (names.empty() ? "" : ", ") + std::string(defect_names[d]);
    return names;
}

void repairs(const DefectOptions& options) {
    Rows rows("mesh,defects,triangles,closed,components,components were,volume error,self-intersections,what is left");
    Hits restored;
    std::size_t without_crossings = 0;
    Table table("mesh | triangles | restored | of | largest error of volume, % | not restored");
    for (std::size_t m = 0; m < options.meshes.size(); ++m) {
        const std::string& file = options.meshes[m];
        const TriangleSoup whole = triangulate(read_polygons(file)).soup;
        const MeshDiagnosis was = diagnose(whole);
        const std::string name = Path(file).filename().string();
        if (!was.closed() || !was.manifold() || !was.oriented()) {
            table.row("{} | not closed, left out | | | |", name);
            continue;
        }
        Hits good;
        double worst = 0;
        std::vector<std::string> failed;
        for (int i = 0; i < options.combinations; ++i) {
            Random random(options.seed, 1000 * m + static_cast<std::size_t>(i));
            const int defects = 1 + static_cast<int>(random.below(all_defects));
            MeshDiagnosis is;
            std::string left;
            try {
                is = repair(with_defects(whole, defects, was.diagonal, random)).after;
                left = fmt::format("{}", fmt::join(is.defects(), "; "));
            } catch (const Error& error) {
                left = error.what();
            }
            const double error = std::abs(is.volume - was.volume) / std::abs(was.volume);
            const bool ok = is.closed() && is.manifold() && is.oriented() && is.components.size() == was.components.size() &&
                            is.euler() == was.euler() && error <= 1e-3;
            good.add(ok);
            without_crossings += ok && is.self_intersections <= was.self_intersections;
            if (ok) worst = std::max(worst, error);
            else failed.push_back(names_of(defects));
            rows(name, names_of(defects), whole.triangles.size(), is.closed(), is.components.size(), was.components.size(), error,
                 is.self_intersections, left);
        }
        restored += good;
        table.row("{} | {} | {} | {} | {:.2g} | {}", name, whole.triangles.size(), good.hits, good.all, 100 * worst,
                  fmt::join(failed, "; "));
    }
    fmt::print(
        "\n{} restored: closed, oriented, a manifold, of the same components and genus, the volume within 0.1 %; {} of these "
        "without new self-intersections\n",
        restored.text(), without_crossings);
    rows.write(options.csv);
}

const Registration registered("repairs", "combinations of defects on closed meshes, and how many are repaired", repairs);

}  // namespace

}  // namespace ostraka::experiments
