// How often pose search finds the position of a broken piece, and how often its verdict is correct.
#include "harness.h"
#include "scenes.h"
#include "shatter.h"

#include "ostraka/core/error.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/registration/part_alignment.h"
#include "ostraka/registration/pose_search.h"
#include "ostraka/synthetic/fragments.h"

#include <cmath>
#include <map>
#include <numbers>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

struct PoseSearchExperiment {
    std::vector<std::string> wholes, members, strangers;
    std::vector<double> shares{0.1, 0.25, 0.5}, noises{0.001, 0.005};
    double erosion = 0.005;
    int pieces = 10;
    std::uint64_t vertices = 25000;
    PoseSearchOptions search;
    std::string csv;
    void declare_options(OptionList& list) {
        list("whole", wholes, "mesh files, or made:NAME: pieces of the same object");
        list("member", members, "TEMPLATE=MEMBER: pieces of another member of the class, in the same frame");
        list("stranger", strangers, "TEMPLATE=OTHER: pieces of unrelated objects");
        list("shares", shares, "sizes of pieces, as shares of the surface");
        list("noises", noises, "standard deviations of noise, as shares of the diagonal");
        list("erosion", erosion, "width of the worn rim, as a share of the diagonal");
        list("pieces", pieces, "number of pieces of each kind", Range{1, 1e6});
        list("vertices", vertices, "number of vertices of synthetic objects");
        list("min-scale", search.min_scale, "min scale of the template");
        list("max-scale", search.max_scale, "max scale of the template");
        list("csv", csv, "file for the raw rows");
    }
};

struct Case {
    std::string name, whole, from;  ///< the whole, and the object from which the piece is broken
    enum class Kind { same, member, stranger } kind = Kind::same;
};
constexpr const char* kind_words[]{"same", "member", "stranger"};

void add_pairs(std::vector<Case>& cases, const std::vector<std::string>& pairs, Case::Kind kind) {
    for (const std::string& pair : pairs) {
        const auto [whole, from] = split_pair(pair);
        cases.push_back({pair, whole, from, kind});
    }
}

/// Error of a pose: rotation in degrees, and displacement of the piece's centre in per cent of the diagonal.
struct PoseError {
    double degrees = 180, percent = 100;
};

PoseError error_of(const Motion& found, const Motion& truth, const Vector3d& middle, double diagonal,
                   const SlippableMotions& slippable) {
    // Slippable motions of the shape do not count: the rotation about an axis, if there is one.
    const Motion between = found.after(truth.inverse());
    const Vector3d there = truth(middle);
    PoseError error{degrees_of(between), 100 * (between(there) - there).norm() / diagonal};
    if (slippable.kind != SlippableKind::none && slippable.contains(between, there, 5 * std::numbers::pi / 180, 0.02 * diagonal))
        error = {0, 0};
    return error;
}

struct Count {
    Hits right, found, decided, decided_right;
    double seconds = 0;
};

/// Registers the pieces of one case to its whole.
class CaseTrial {
public:
    CaseTrial(const Case& trial, const PoseSearchExperiment& options, Rows& csv)
        : case_(trial),
          options_(options),
          csv_(csv),
          whole_(read_or_make(trial.whole, options.vertices, 1)),
          other_(read_or_make(trial.from, options.vertices, 2)),
          surface_(whole_) {
        if (trial.kind == Case::Kind::stranger) {
            // Scaled to the size of the whole, so that size does not reveal it.
            other_ = scaled_by(other_, std::sqrt(surface_area(whole_) / surface_area(other_)));
        }
        const Stopwatch building;
        search_.emplace(surface_, options.search);
        fmt::print(stderr, "{}: prepared in {:g} s\n", trial.name, building.seconds().processor);
    }

    /// Counts nothing if no such piece can be broken off.
    void lay(double share, double noise, std::uint64_t seed, std::map<std::string, Count>& table) const {
        Random random(seed, 77);
        const Mesh& source = case_.kind == Case::Kind::same ? whole_ : other_;
        const Point centre = source.point(Vertex(static_cast<Index>(random.below(source.number_of_vertices()))));
        FragmentOptions breaking;
        breaking.share = share;
        breaking.noise = noise;
        breaking.erosion = options_.erosion;
        breaking.seed = seed;
        std::optional<SyntheticFragment> piece;
        try {
            piece = generate_fragment(source, centre, breaking);
        } catch (const Error&) {
            return;
        }
        judge(*piece, share, noise, seed, table[fmt::format("{} | {:g} | {:g}", case_.name, 100 * share, 100 * noise)]);
    }

private:
    /// True position of a piece on the whole.
    [[nodiscard]] Motion truth_of(const SyntheticFragment& piece) const {
        if (case_.kind != Case::Kind::member) return piece.pose;
        if (whole_.number_of_vertices() == other_.number_of_vertices()) {
            std::vector<Vector3d> from, to;
            for (const Vertex v : piece.mesh.vertices()) {
                from.push_back(eigen(piece.mesh.point(v)));
                to.push_back(eigen(whole_.point(Vertex(piece.vertices[v]))));
            }
            return fit_motion(from, to);
        }
        PartAlignmentOptions aligning;
        aligning.samples = 600;
        aligning.iterations = 30;
        aligning.angle = 95;
        return align_part(piece.mesh, {}, surface_, piece.pose, {}, aligning).pose;
    }

    void judge(const SyntheticFragment& piece, double share, double noise, std::uint64_t seed, Count& count) const {
        const Vector3d middle = surface_centre(piece.mesh);
        const Motion truth = truth_of(piece);
        const double diagonal = box_diagonal(whole_);
        const Stopwatch watch;
        const PoseSearchResult result = search_->find(piece.mesh);
        const double seconds = watch.seconds().processor;
        const PoseCandidate& best = result.candidates.front();
        const PoseError error = error_of(best.pose, truth, middle, diagonal, result.slippable);
        const bool member = case_.kind == Case::Kind::member;
        const bool right =
            case_.kind != Case::Kind::stranger && error.degrees < (member ? 15 : 5) && error.percent < (member ? 5 : 2);
        int rank = -1;
        for (std::size_t c = 0; c < result.candidates.size() && rank < 0; ++c) {
            const PoseError e = error_of(result.candidates[c].pose, truth, middle, diagonal, {});
            if (e.degrees < 15 && e.percent < 5) rank = static_cast<int>(c);
        }
        count.right.add(right), count.found.add(rank >= 0), count.decided.add(result.decided);
        if (result.decided) count.decided_right.add(right);
        count.seconds += seconds;
        csv_(case_.name, kind_words[static_cast<int>(case_.kind)], share, noise, options_.erosion, seed, error.degrees,
             error.percent, right, rank >= 0, best.score, best.share,
             result.candidates.size() > 1 ? result.candidates[1].score : 0, result.margin, result.confidence, result.decided,
             to_string(result.slippable.kind), seconds, rank);
    }

    const Case& case_;
    const PoseSearchExperiment& options_;
    Rows& csv_;
    Mesh whole_, other_;
    SurfaceSearch surface_;
    std::optional<PoseSearch> search_;
};

void pose_search(const PoseSearchExperiment& options) {
    std::vector<Case> cases;
    for (const std::string& name : options.wholes) cases.push_back({name, name, name, Case::Kind::same});
    add_pairs(cases, options.members, Case::Kind::member);
    add_pairs(cases, options.strangers, Case::Kind::stranger);
    Rows csv(
        "case,kind,share,noise,erosion,seed,degrees,percent,right,found,score,share_on,second,margin,confidence,decided,freedom,"
        "seconds,rank");
    std::map<std::string, Count> counts;
    for (const Case& each : cases) {
        const CaseTrial trial(each, options, csv);
        for (const double share : options.shares)
            for (const double noise : options.noises)
                for (int k = 0; k < options.pieces; ++k) trial.lay(share, noise, static_cast<std::uint64_t>(1 + k), counts);
    }
    Table table(
        "piece of | % of the surface | noise % | pieces | right % | among the candidates % | decided % | of these right % | s "
        "each");
    for (const auto& [name, count] : counts)
        table.row("{} | {} | {:.0f} | {:.0f} | {:.0f} | {} | {:.2f}", name, count.right.all, count.right.percent(),
                  count.found.percent(), count.decided.percent(),
                  count.decided.hits > 0 ? fmt::format("{:.0f}", count.decided_right.percent()) : "-",
                  count.seconds / static_cast<double>(count.right.all));
    csv.write(options.csv);
}

const Registration registered("pose-search", "pieces broken off objects, and where a search lays them", pose_search);

}  // namespace

}  // namespace ostraka::experiments
