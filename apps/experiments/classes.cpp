// Leave-one-out classification of the objects of a benchmark, and the number of members that a class needs: classes are learnt
// from fits of one template each, and each object is classified by classes learnt without it.
#include "class_objects.h"
#include "harness.h"
#include "scenes.h"

#include "ostraka/shape_classes/classify.h"
#include "ostraka/shape_classes/dissimilarity.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

namespace ostraka::experiments {

namespace {

/// Settings of the fits of templates to objects.
struct FitSettings {
    std::string output = "experiments-output/classes";
    std::uint64_t template_vertices = 1000, object_vertices = 3000;
    int tries = 1;
    double search_radius = 0.1;
};

constexpr std::size_t every = 1000;  ///< number of members: all available

/// Variant of learning and classification.
struct Way {
    bool shared = true;     ///< thresholds of the classes are moderated by each other
    bool strangers = true;  ///< out-of-class objects determine the acceptance limits
    bool strict = false;    ///< of ClassifyOptions
    std::size_t members = every;
    double accept = 0.05;  ///< of LearnOptions
    bool with_its_class = true;
    [[nodiscard]] std::string file() const {
        return std::string(shared ? "" : "-alone") + (strangers ? "" : "-members") + (strict ? "-strict" : "") +
               (members < every ? "-of" + std::to_string(members) : "");
    }
    [[nodiscard]] std::string text() const {
        return std::string(shared ? "" : "; each class by its own members' deviations alone") +
               (strangers ? "" : "; without strangers") +
               (strict ? "; the template has to lie on the object by the fixed limit" : "") +
               (members < every ? "; of " + std::to_string(members) + " members" : "");
    }
};

const std::array<const char*, 3> known_of_parts{"no annotations", "annotations of the template, laid on by the fit",
                                                "annotations of the template and of the objects"};

std::string share_of(const Hits& hits) { return hits.all == 0 ? "-" : fmt::format("{:.1f}", hits.percent()); }

/// Objects recognised and refused by their own class, accepted by another one, and by any other one.
struct Rates {
    Hits recognised, refused, accepted, open;

    /// Adds the answers about an object of a class; with `only`, the answers of these classes only.
    void add(const std::vector<ClassAnswer>& list, const std::string& object_class, const std::set<std::string>& only = {}) {
        bool is_recognised = false, is_refused = false, any = false;
        for (const ClassAnswer& answer : list) {
            if (!only.empty() && only.count(answer.name) == 0) continue;
            const bool member = answer.verdict == Membership::member;
            if (answer.name == object_class) {
                is_recognised = member, is_refused = answer.verdict == Membership::other;
                continue;
            }
            accepted.add(member);
            any = any || member;
        }
        recognised.add(is_recognised), refused.add(is_refused), open.add(any);
    }
    [[nodiscard]] std::string text() const { return share_of(recognised) + ", " + share_of(accepted) + ", " + share_of(open); }
};

using Counts = std::map<std::string, std::map<std::string, int>>;

void print(const Counts& counts, const std::vector<std::string>& columns) {
    Table table(fmt::format(" | {}", fmt::join(columns, " | ")));
    for (const auto& [class_name, row] : counts) {
        std::string cells = class_name;
        for (const std::string& name : columns) cells += " | " + (row.contains(name) ? std::to_string(row.at(name)) : "");
        table.add(cells);
    }
}

/// An object compared with a class: its dissimilarity, infinite if it fails another criterion.
struct Compared {
    std::string object_class;
    std::size_t object;
    std::string compared;
    double dissimilarity;
};
double dissimilarity_unless_rejected(const ClassAnswer& answer) {
    const bool against = std::any_of(answer.rejecting_checks.begin(), answer.rejecting_checks.end(),
                                     [&](std::size_t k) { return answer.checks[k].quantity.name != unlike_the_members; });
    return against || !answer.fit_problem.empty() || !answer.dissimilarity ? std::numeric_limits<double>::infinity()
                                                                           : *answer.dissimilarity;
}

/// Prints the accepted out-of-class objects against the recognised members for an increasing common limit of dissimilarity.
void print_curve(const std::vector<Compared>& points, const char* title, const std::set<std::string>& only) {
    std::vector<double> members, others;
    std::map<std::size_t, double> nearest;
    for (const Compared& point : points) {
        if (!only.empty() && (only.count(point.object_class) == 0 || only.count(point.compared) == 0)) continue;
        (point.object_class == point.compared ? members : others).push_back(point.dissimilarity);
        if (point.object_class == point.compared) continue;
        double& least = nearest.try_emplace(point.object, point.dissimilarity).first->second;
        least = std::min(least, point.dissimilarity);
    }
    std::sort(members.begin(), members.end());
    fmt::print("\nAccepted against recognised, {}:\n\n", title);
    Table table("recognised % | limit | accepted by a class % | by any %");
    for (const int per_cent : {50, 60, 70, 75, 80, 85, 90, 95}) {
        const std::size_t k = (members.size() * static_cast<std::size_t>(per_cent) + 99) / 100;
        const double limit = members[std::max<std::size_t>(1, k) - 1];
        if (!std::isfinite(limit)) break;
        Hits accepted, by_any;
        for (const double dissimilarity : others) accepted.add(dissimilarity <= limit);
        for (const auto& [object, dissimilarity] : nearest) by_any.add(dissimilarity <= limit);
        table.row("{} | {:.2f} | {:.1f} | {:.1f}", per_cent, limit, accepted.percent(), by_any.percent());
    }
}

class LeaveOneOut {
public:
    /// Fits the templates. The first training object of each class provides its template; for that object itself, the second
    /// does.
    LeaveOneOut(const std::vector<ClassObject>& objects, const FitSettings& settings) : objects_(objects), settings_(settings) {
        for (std::size_t i = 0; i < objects.size(); ++i) objects_of_class_[objects[i].class_name].push_back(i);
        for (const auto& [name, list] : objects_of_class_) {
            (half_.size() > rest_.size() ? rest_ : half_).insert(name);
            class_names_.push_back(name);
        }
        how_.correspondence = CorrespondenceChoice::fitted;
        how_.fit.tries = settings.tries;
        how_.fit.fit.search_radius = settings.search_radius;
        how_.fit.fit.levels = 5;
        how_.fit.fit.steps = 2;
        how_.fit.alignment.samples = 400;
        Rows csv("template,object,annotations,kind,id,name,value");
        std::vector<double> seconds;
        for (const auto& [class_name, list] : objects_of_class_)
            for (std::size_t first = 0; first < std::min<std::size_t>(2, list.size()); ++first) {
                if (first > 0 && !objects_[list.front()].asked) break;
                Source& source = sources_.emplace_back();
                source.class_name = class_name;
                source.object = list[first];
                fit(source, first > 0, csv, seconds);
            }
        csv.write(Path(settings_.output) / "quantities.csv");
        fmt::print("{} fits, {:.2f} s each (median)\n", seconds.size(), upper_median(seconds));
    }

    /// Classifies every object with classes learnt without it.
    void ask(std::size_t arm, const Way& way) const;
    /// Recognition and acceptance rates for increasing permitted shares of accepted out-of-class objects, by number of members.
    void ask_at_rates(std::size_t arm, bool shared, const std::vector<std::size_t>& members,
                      const std::vector<double>& rates) const;
    /// Classifies out-of-class objects with all classes and all their members.
    void ask_made(const std::vector<ClassObject>& made, std::size_t arm) const;

private:
    /// A class's template, made from one object, with the measurements from its fits to other objects.
    struct Source {
        std::string class_name;
        std::size_t object = 0;
        Mesh mesh;
        AnnotationSet parts;
        std::array<std::map<std::size_t, LearntMember>, 3> measured;  ///< [available information], by object
    };

    /// The classes learnt without an object.
    struct Classes {
        std::vector<const Source*> sources;
        std::vector<ShapeClass> learnt;
    };

    void fit(Source& source, bool second, Rows& csv, std::vector<double>& seconds);
    [[nodiscard]] Classes classes_for(std::size_t object, std::size_t arm, const Way& way) const;
    [[nodiscard]] std::vector<ClassAnswer> answers_of(const Classes& known, std::size_t object, std::size_t arm,
                                                      const Way& way) const;
    /// Learns a class. The out-of-class objects are those of the other classes, except the class of the object to be
    /// classified, which is treated as unseen.
    [[nodiscard]] ShapeClass learnt_from(const Source& source, std::size_t arm, std::size_t without, const Way& way) const;
    [[nodiscard]] ClassTemplate template_of(const Source& source, bool with_parts) const {
        return {{source.mesh, with_parts ? source.parts : none_}, no_graph_};
    }

    const std::vector<ClassObject>& objects_;
    const FitSettings settings_;
    std::map<std::string, std::vector<std::size_t>> objects_of_class_;
    std::vector<std::string> class_names_;
    std::set<std::string> half_, rest_;  ///< every second class, sorted by name, and the others
    std::vector<Source> sources_;
    LearnOptions how_;
    const AnnotationSet none_;
    const RelationGraph no_graph_;
};

void LeaveOneOut::fit(Source& source, bool second, Rows& csv, std::vector<double>& seconds) {
    constexpr std::size_t max_strangers = 6;  // of each class
    const ClassObject& from = objects_[source.object];
    source.mesh = simplified(from.member.mesh, settings_.template_vertices);
    if (!from.labels.empty()) source.parts = parts_on(source.mesh, from.original, from.labels);
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const ClassObject& object = objects_[i];
        // The second source needs out-of-class objects only for its limits; a third of them is enough.
        const bool member = object.class_name == source.class_name;
        if (i == source.object || (second && !member && i % 3 != 0)) continue;
        if (!member && !object.asked && i - objects_of_class_.at(object.class_name).front() >= max_strangers) continue;
        const WholeObject bare{{object.member.mesh, {}}, object.member.name};
        const Stopwatch watch;
        const MemberFit fitted = fit_member({source.mesh, {}}, bare, how_.fit);
        seconds.push_back(watch.seconds().processor);
        for (std::size_t arm = 0; arm < 3; ++arm) {
            LearntMember& measured = source.measured.at(arm)[i];
            measured = measure_member(template_of(source, arm > 0), arm < 2 ? bare : object.member, fitted, how_, &object.whole);
            for (const ClassQuantity& q : measured.quantities)
                if (q.value) csv(from.member.name, object.member.name, arm, to_string(q.kind), q.id, q.name, *q.value);
        }
    }
}

ShapeClass LeaveOneOut::learnt_from(const Source& source, std::size_t arm, std::size_t without, const Way& way) const {
    std::vector<LearntMember> members, strangers;
    const std::string unseen = without < objects_.size() ? objects_[without].class_name : "";
    for (const auto& [i, measured] : source.measured.at(arm)) {
        if (i == without || !objects_[i].learnt) continue;
        if (objects_[i].class_name == source.class_name) {
            if (members.size() < way.members) members.push_back(measured);
        } else if (way.strangers && objects_[i].class_name != unseen) {
            strangers.push_back(measured);
        }
    }
    ShapeClass learnt = learn_class(template_of(source, arm > 0), members, how_, strangers);
    learnt.name = source.class_name;
    return learnt;
}

LeaveOneOut::Classes LeaveOneOut::classes_for(std::size_t i, std::size_t arm, const Way& way) const {
    Classes known;
    for (const Source& source : sources_) {
        if (source.object == i || (!known.sources.empty() && known.sources.back()->class_name == source.class_name)) continue;
        known.sources.push_back(&source);
        known.learnt.push_back(learnt_from(source, arm, i, way));
    }
    return known;
}

std::vector<ClassAnswer> LeaveOneOut::answers_of(const Classes& known, std::size_t i, std::size_t arm, const Way& way) const {
    const auto compared = [&](bool with_its_class) {
        std::vector<ShapeClass> classes;
        std::vector<const Source*> sources;
        for (std::size_t k = 0; k < known.learnt.size(); ++k)
            if (with_its_class || known.learnt[k].name != objects_[i].class_name)
                classes.push_back(known.learnt[k]), sources.push_back(known.sources[k]);
        for (ShapeClass& learnt : classes) {
            learnt.accept = way.accept;
            learn_thresholds(learnt);
        }
        if (way.shared) moderate_thresholds(classes);
        ClassifyOptions how;
        how.strict = way.strict;
        std::vector<ClassAnswer> list;
        for (std::size_t k = 0; k < classes.size(); ++k)
            list.push_back(compare_with(classes[k], sources[k]->measured.at(arm).at(i), how));
        return list;
    };
    if (way.with_its_class) return compared(true);
    std::vector<ClassAnswer> list = compared(false);
    for (ClassAnswer& answer : compared(true))
        if (answer.name == objects_[i].class_name) list.push_back(std::move(answer));
    return list;
}

void LeaveOneOut::ask(std::size_t arm, const Way& way) const {
    Counts nearest, decided;
    std::map<std::string, int> sums;
    Hits near;
    Rates rates;
    Rows answers("object,class,verdict,score,unlike,off,against,first reason");
    std::vector<Compared> curve;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const ClassObject& object = objects_[i];
        if (!object.asked) continue;
        std::vector<ClassAnswer> list = answers_of(classes_for(i, arm, way), i, arm, way);
        rates.add(list, object.class_name);
        for (const ClassAnswer& answer : list) {
            const auto reasons = answer.reasons();
            answers(object.member.name, answer.name, to_string(answer.verdict), answer.score, answer.dissimilarity.value_or(-1),
                    answer.fit.residuals ? answer.fit.residuals->off() : 0, answer.rejecting_checks.size(),
                    reasons.empty() ? answer.undecided : reasons.front());
            curve.push_back({object.class_name, i, answer.name, dissimilarity_unless_rejected(answer)});
        }
        const Classification result = decide(object.member.name, std::move(list));
        const auto name = [&](int k) { return result.answers[static_cast<std::size_t>(k)].name; };
        const std::string best = result.best >= 0                      ? name(result.best)
                                 : result.verdict == Membership::other ? "none"
                                                                       : "undecided";
        ++nearest[object.class_name][name(result.nearest)];
        ++decided[object.class_name][best];
        near.add(name(result.nearest) == object.class_name);
        ++sums[best == object.class_name ? "right" : result.best >= 0 ? "wrong" : best];
    }
    answers.write(Path(settings_.output) / fmt::format("answers-{}{}.csv", arm, way.file()));
    fmt::print("\n## {}{}\n\nNearest class: {} right.\n\n", known_of_parts.at(arm), way.text(), near.text());
    print(nearest, class_names_);
    fmt::print(
        "\nAnswers: {} right, {} wrong, {} none, {} undecided. Its own class recognises {} objects and refuses {}; another one "
        "accepts one {} times in {}; without its own class {} objects are accepted by one or more.\n\n",
        sums["right"], sums["wrong"], sums["none"], sums["undecided"], rates.recognised.text(), rates.refused.hits,
        rates.accepted.hits, rates.accepted.all, rates.open.text());
    std::vector<std::string> columns = class_names_;
    columns.insert(columns.end(), {"none", "undecided"});
    print(decided, columns);
    print_curve(curve, "all classes", {});
    if (half_.size() < 2) return;
    print_curve(curve, "the classes that choices were made on", half_);
    print_curve(curve, "the other classes", rest_);
}

void LeaveOneOut::ask_at_rates(std::size_t arm, bool shared, const std::vector<std::size_t>& members,
                               const std::vector<double>& rates) const {
    fmt::print("\n## Limits by strangers, {}{}\n\n", known_of_parts.at(arm), Way{.shared = shared}.text());
    Table table(
        "members | accept % | recognised % | refused % | accepted by a class % | by any % | tuned on: recognised, by a class, by "
        "any | others");
    for (const std::size_t count : members) {
        Way way{.shared = shared, .members = count, .with_its_class = false};
        std::vector<std::array<Rates, 3>> results(rates.size());
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            if (!objects_[i].asked) continue;
            const Classes known = classes_for(i, arm, way);
            const std::string& class_name = objects_[i].class_name;
            for (std::size_t r = 0; r < rates.size(); ++r) {
                way.accept = rates[r];
                const std::vector<ClassAnswer> list = answers_of(known, i, arm, way);
                results[r][0].add(list, class_name);
                const bool first = half_.count(class_name) > 0;
                results[r][first ? 1 : 2].add(list, class_name, first ? half_ : rest_);
            }
        }
        for (std::size_t r = 0; r < rates.size(); ++r) {
            const auto& [all, tuned, others] = results[r];
            table.row("{} | {:.0f} | {} | {} | {} | {} | {} | {}", count < every ? std::to_string(count) : "all", 100 * rates[r],
                      share_of(all.recognised), share_of(all.refused), share_of(all.accepted), share_of(all.open), tuned.text(),
                      others.text());
        }
    }
}

void LeaveOneOut::ask_made(const std::vector<ClassObject>& made, std::size_t arm) const {
    Classes known = classes_for(objects_.size(), arm, {});
    moderate_thresholds(known.learnt);
    fmt::print("\n## Made strangers, {}\n\n", known_of_parts.at(arm));
    Table table(" | answer | accepted by | undecided | nearest | unlike it | off it %");
    for (const ClassObject& object : made) {
        std::vector<ClassAnswer> list;
        int members = 0, open = 0;
        for (std::size_t k = 0; k < known.learnt.size(); ++k) {
            list.push_back(compare_with(
                known.learnt[k], learn_member(template_of(*known.sources[k], arm > 0), object.member, how_, &object.whole)));
            members += list.back().verdict == Membership::member ? 1 : 0;
            open += list.back().verdict == Membership::undecided ? 1 : 0;
        }
        const Classification answer = decide(object.member.name, std::move(list));
        const ClassAnswer& near = answer.answers[static_cast<std::size_t>(answer.nearest)];
        table.row("{} | {} | {} | {} | {} | {:.2f} | {:.0f}", object.member.name, to_string(answer.verdict), members, open,
                  near.name, near.dissimilarity.value_or(-1), 100 * near.fit.residuals->off());
    }
}

struct ClassMembershipOptions : FitSettings {
    std::string models, labels;
    std::uint64_t members = 1000;
    void declare_options(OptionList& list) {
        list("models", models, "folder with <class>/<number>.off").positional().required();
        list("output", output, "output folder");
        list("labels", labels, "folder with <class>/<number>/*.seg");
        list("members", members, "max number of members of each class");
        list("vertices", template_vertices, "number of vertices of the templates");
        list("object-vertices", object_vertices, "max number of vertices of the objects");
        list("tries", tries, "number of placements that are fitted", Range{1, 5});
        list("search-radius", search_radius, "search radius of the first level, as a share of the diagonal");
    }
};

/// Templates are fitted to the models of a benchmark, and each model is left out when its class is learnt.
void class_membership(const ClassMembershipOptions& options) {
    std::vector<ClassObject> objects = read_class_objects(options.models, options.members);
    for (ClassObject& object : objects) {
        object.whole = measure_whole_shape(object.member.mesh);
        object.original = object.member.mesh;
        object.member.mesh = simplified(object.original, options.object_vertices);
        if (options.labels.empty()) continue;
        const std::string number = object.member.name.substr(object.class_name.size() + 1);
        object.labels = typical_labels(Path(options.labels) / object.class_name / number, object.original);
        object.member.annotations = parts_on(object.member.mesh, object.original, object.labels);
    }
    LeaveOneOut membership(objects, options);
    const std::vector<ClassObject> made = made_strangers();
    for (std::size_t arm = 0; arm < (options.labels.empty() ? 1 : 3); ++arm) {
        for (const Way& way :
             {Way{}, Way{true, false}, Way{false, true}, Way{false, false}, Way{true, true, true}, Way{true, true, false, 3}})
            membership.ask(arm, way);
        membership.ask_made(made, arm);
        if (arm == 0) membership.ask_at_rates(arm, true, {3, every}, {0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5});
    }
}

struct ClassSizeOptions {
    std::string output = "experiments-output/class-size";
    std::uint64_t vertices = 4000, seed = 1;
    void declare_options(OptionList& list) {
        list("output", output, "output folder");
        list("vertices", vertices, "number of vertices of each object; thin handles need about 4000");
        list("seed", seed, "random seed of the variation between members");
    }
};

/// Eight synthetic classes whose members differ in proportions, taper and bend, learnt from increasing numbers of members.
void class_size(const ClassSizeOptions& options) {
    constexpr std::size_t most = 20, asked = 5;
    std::vector<ClassObject> objects = made_classes(most + 1, asked, options.seed, options.vertices);
    for (ClassObject& object : objects) object.whole = measure_whole_shape(object.member.mesh);
    LeaveOneOut membership(objects, {.output = options.output});
    for (const bool shared : {true, false}) membership.ask_at_rates(0, shared, {3, 5, 10, most}, {0.02, 0.05, 0.1, 0.2, 0.5});
}

const Registration registered_classes("classes", "which class an object belongs to, leave one out", class_membership);
const Registration registered_size("class-size", "how many members a class needs, of made ones", class_size);

}  // namespace

}  // namespace ostraka::experiments
