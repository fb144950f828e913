#include "class_leave_one_out.h"

#include "ostraka/shape_classes/dissimilarity.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <limits>

namespace ostraka::experiments {

namespace {

const std::array<const char*, 3> known_of_parts{"no annotations", "annotations of the template, laid on by the fit",
                                                "annotations of the template and of the objects"};

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
struct Asked {
    std::string object_class;
    std::size_t object;
    std::string asked;
    double unlike;
};
double unlike_where_nothing_else_speaks(const ClassAnswer& answer) {
    const bool against = std::any_of(answer.against.begin(), answer.against.end(),
                                     [&](std::size_t k) { return answer.checks[k].quantity.name != unlike_the_members; });
    return against || !answer.off.empty() || !answer.unlike ? std::numeric_limits<double>::infinity() : *answer.unlike;
}

/// Prints the accepted out-of-class objects against the recognised members for an increasing common limit of dissimilarity.
void print_curve(const std::vector<Asked>& points, const char* title, const std::set<std::string>& only) {
    std::vector<double> own, others;
    std::map<std::size_t, double> nearest;
    for (const Asked& point : points) {
        if (!only.empty() && (only.count(point.object_class) == 0 || only.count(point.asked) == 0)) continue;
        if (point.object_class == point.asked) {
            own.push_back(point.unlike);
            continue;
        }
        others.push_back(point.unlike);
        const auto found = nearest.try_emplace(point.object, point.unlike).first;
        found->second = std::min(found->second, point.unlike);
    }
    std::sort(own.begin(), own.end());
    fmt::print("\nAccepted against recognised, {}:\n\n", title);
    Table table("recognised % | limit | accepted by a class % | by any %");
    for (const int per_cent : {50, 60, 70, 75, 80, 85, 90, 95}) {
        const std::size_t k = (own.size() * static_cast<std::size_t>(per_cent) + 99) / 100;
        const double limit = own[std::max<std::size_t>(1, k) - 1];
        if (!std::isfinite(limit)) break;
        const auto share = [&](const auto& list, const auto& value) {
            const auto accepted = std::count_if(list.begin(), list.end(), [&](const auto& one) { return value(one) <= limit; });
            return percentage(static_cast<std::size_t>(accepted), list.size());
        };
        table.row("{} | {:.2f} | {:.1f} | {:.1f}", per_cent, limit, share(others, [](double x) { return x; }),
                  share(nearest, [](const auto& x) { return x.second; }));
    }
}

std::string share_of(std::size_t part, std::size_t all) { return all == 0 ? "-" : fmt::format("{:.1f}", percentage(part, all)); }

}  // namespace

void Rates::add(const std::vector<ClassAnswer>& list, const std::string& of, const std::set<std::string>& only) {
    ++objects;
    bool any = false;
    for (const ClassAnswer& one : list) {
        if (!only.empty() && only.count(one.name) == 0) continue;
        const bool member = one.verdict == Membership::member;
        if (one.name == of) {
            recognised += member ? 1 : 0;
            refused += one.verdict == Membership::other ? 1 : 0;
            continue;
        }
        ++asked;
        accepted += member ? 1 : 0;
        any = any || member;
    }
    open += any ? 1 : 0;
}

std::string Rates::text() const {
    return share_of(recognised, objects) + ", " + share_of(accepted, asked) + ", " + share_of(open, objects);
}

LeaveOneOut::LeaveOneOut(const std::vector<ClassObject>& objects, const FitSettings& settings)
    : objects_(objects), settings_(settings) {
    for (std::size_t i = 0; i < objects.size(); ++i) objects_of_class_[objects[i].class_name].push_back(i);
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

void LeaveOneOut::fit(Source& source, bool second, Rows& csv, std::vector<double>& seconds) {
    constexpr std::size_t max_strangers = 6;  // of each class
    const ClassObject& from = objects_[source.object];
    source.mesh = simplified(from.member.mesh, settings_.template_vertices);
    if (!from.labels.empty()) source.parts = parts_on(source.mesh, from.original, from.labels);
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const ClassObject& object = objects_[i];
        // The second source needs out-of-class objects only for its limits; a third of them is enough.
        const bool own = object.class_name == source.class_name;
        if (i == source.object || (second && !own && i % 3 != 0)) continue;
        if (!own && !object.asked && i - objects_of_class_.at(object.class_name).front() >= max_strangers) continue;
        const Stopwatch watch;
        source.fits[i] = fit_member({source.mesh, {}}, {{object.member.mesh, {}}, object.member.name}, how_.fit);
        seconds.push_back(watch.seconds().processor);
        measure(source, i);
        for (std::size_t arm = 0; arm < 3; ++arm)
            for (const ClassQuantity& one : source.measured.at(arm)[i].quantities)
                if (one.value) csv(from.member.name, object.member.name, arm, to_string(one.kind), one.id, one.name, *one.value);
    }
}

void LeaveOneOut::measure(Source& source, std::size_t i) {
    const WholeObject& with = objects_[i].member;
    const WholeObject bare{{with.mesh, {}}, with.name};
    const MemberFit& fit = source.fits.at(i);
    const ClassTemplate plain{{source.mesh, none_}, no_graph_}, known{{source.mesh, source.parts}, no_graph_};
    source.measured[0][i] = measure_member(plain, bare, fit, how_, &objects_[i].whole);
    source.measured[1][i] = measure_member(known, bare, fit, how_, &objects_[i].whole);
    source.measured[2][i] = measure_member(known, with, fit, how_, &objects_[i].whole);
}

ShapeClass LeaveOneOut::learnt_from(const Source& source, std::size_t arm, std::size_t without, const Way& way) const {
    std::vector<LearntMember> members, strangers;
    const std::string of = without < objects_.size() ? objects_[without].class_name : "";
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const auto found = source.measured.at(arm).find(i);
        if (i == without || found == source.measured.at(arm).end()) continue;
        if (!objects_[i].learnt) continue;
        const LearntMember& one = found->second;
        if (objects_[i].class_name == source.class_name) {
            if (members.size() < way.members) members.push_back(one);
        } else if (way.strangers && objects_[i].class_name != of) {
            strangers.push_back(one);
        }
    }
    ShapeClass learnt = learn_class({{source.mesh, arm == 0 ? none_ : source.parts}, no_graph_}, members, how_, strangers);
    learnt.name = source.class_name;
    return learnt;
}

LeaveOneOut::Classes LeaveOneOut::classes_for(std::size_t i, std::size_t arm, const Way& way) const {
    Classes known;
    for (const auto& [class_name, members] : objects_of_class_)
        for (const Source& source : sources_)
            if (source.class_name == class_name && source.object != i) {
                known.sources.push_back(&source);
                known.learnt.push_back(learnt_from(source, arm, i, way));
                break;
            }
    return known;
}

std::vector<ClassAnswer> LeaveOneOut::answers_of(const Classes& known, std::size_t i, std::size_t arm, const Way& way) const {
    const auto asked = [&](bool own) {
        std::vector<ShapeClass> classes;
        std::vector<const Source*> sources;
        for (std::size_t k = 0; k < known.learnt.size(); ++k)
            if (own || known.learnt[k].name != objects_[i].class_name)
                classes.push_back(known.learnt[k]), sources.push_back(known.sources[k]);
        for (ShapeClass& one : classes) {
            one.accept = way.accept;
            learn_thresholds(one);
        }
        if (way.shared) moderate_thresholds(classes);
        ClassifyOptions how;
        how.strict = way.strict;
        std::vector<ClassAnswer> list;
        for (std::size_t k = 0; k < classes.size(); ++k)
            list.push_back(compare_with(classes[k], sources[k]->measured.at(arm).at(i), how));
        return list;
    };
    if (way.own) return asked(true);
    std::vector<ClassAnswer> list = asked(false);
    for (ClassAnswer& one : asked(true))
        if (one.name == objects_[i].class_name) list.push_back(std::move(one));
    return list;
}

void LeaveOneOut::ask(std::size_t arm, const Way& way) const {
    Counts nearest, decided;
    std::map<std::string, int> sums;
    std::size_t near = 0, own_refused = 0, own_recognised = 0, accepted = 0, asked = 0, open = 0;
    Rows answers("object,class,verdict,score,unlike,off,against,first reason");
    std::vector<Asked> curve;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        const ClassObject& object = objects_[i];
        if (!object.asked) continue;
        std::vector<ClassAnswer> list = answers_of(classes_for(i, arm, way), i, arm, way);
        bool any_other = false;
        for (const ClassAnswer& one : list) {
            const bool member = one.verdict == Membership::member;
            const auto reasons = one.reasons();
            answers(object.member.name, one.name, to_string(one.verdict), one.score, one.unlike.value_or(-1),
                    one.fit.residuals ? one.fit.residuals->off() : 0, one.against.size(),
                    reasons.empty() ? one.undecided : reasons.front());
            curve.push_back({object.class_name, i, one.name, unlike_where_nothing_else_speaks(one)});
            if (one.name == object.class_name) {
                own_refused += one.verdict == Membership::other ? 1 : 0;
                own_recognised += member ? 1 : 0;
            } else {
                ++asked;
                accepted += member ? 1 : 0;
                any_other = any_other || member;
            }
        }
        open += any_other ? 1 : 0;
        const Classification answer = decide(object.member.name, std::move(list));
        const auto name = [&](int k) { return answer.answers[static_cast<std::size_t>(k)].name; };
        const std::string best = answer.best >= 0                      ? name(answer.best)
                                 : answer.verdict == Membership::other ? "none"
                                                                       : "undecided";
        ++nearest[object.class_name][name(answer.nearest)];
        ++decided[object.class_name][best];
        near += name(answer.nearest) == object.class_name ? 1 : 0;
        ++sums[best == object.class_name ? "right" : answer.best >= 0 ? "wrong" : best];
    }
    const std::size_t n = objects_.size();
    answers.write(Path(settings_.output) / fmt::format("answers-{}{}.csv", arm, way.file()));
    fmt::print("\n## {}{}\n\nNearest class: {} of {} right.\n\n", known_of_parts.at(arm), way.text(), near, n);
    std::vector<std::string> columns;
    for (const auto& [class_name, list] : objects_of_class_) columns.push_back(class_name);
    print(nearest, columns);
    fmt::print(
        "\nAnswers: {} right, {} wrong, {} none, {} undecided. Its own class recognises {} of {} objects and refuses {}; another "
        "one "
        "accepts one {} times in {}; without its own class {} of {} objects are accepted by one or more.\n\n",
        sums["right"], sums["wrong"], sums["none"], sums["undecided"], own_recognised, n, own_refused, accepted, asked, open, n);
    columns.emplace_back("none");
    columns.emplace_back("undecided");
    print(decided, columns);
    print_curve(curve, "all classes", {});
    if (const auto half = first_half(); half.size() > 1) {
        print_curve(curve, "the classes that choices were made on", half);
        print_curve(curve, "the other classes", rest(half));
    }
}

void LeaveOneOut::ask_at_rates(std::size_t arm, bool shared, const std::vector<std::size_t>& members,
                               const std::vector<double>& rates) const {
    fmt::print("\n## Limits by strangers, {}{}\n\n", known_of_parts.at(arm), Way{.shared = shared}.text());
    Table table(
        "members | accept % | recognised % | refused % | accepted by a class % | by any % | tuned on: recognised, by a class, by "
        "any "
        "| others");
    const std::set<std::string> half = first_half(), others = rest(half);
    for (const std::size_t count : members) {
        Way way;
        way.shared = shared;
        way.members = count;
        way.own = false;
        std::vector<std::array<Rates, 3>> found(rates.size());
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            if (!objects_[i].asked) continue;
            const Classes known = classes_for(i, arm, way);
            const std::string& of = objects_[i].class_name;
            for (std::size_t r = 0; r < rates.size(); ++r) {
                way.accept = rates[r];
                const std::vector<ClassAnswer> list = answers_of(known, i, arm, way);
                found[r][0].add(list, of);
                const bool first = half.count(of) > 0;
                found[r][first ? 1 : 2].add(list, of, first ? half : others);
            }
        }
        for (std::size_t r = 0; r < rates.size(); ++r) {
            const Rates& all = found[r][0];
            table.row("{} | {:.0f} | {} | {} | {} | {} | {} | {}", count < every ? std::to_string(count) : "all", 100 * rates[r],
                      share_of(all.recognised, all.objects), share_of(all.refused, all.objects),
                      share_of(all.accepted, all.asked), share_of(all.open, all.objects), found[r][1].text(), found[r][2].text());
        }
    }
}

void LeaveOneOut::ask_made(const std::vector<ClassObject>& made, std::size_t arm) const {
    std::vector<ShapeClass> classes;
    std::vector<const Source*> asked;
    for (const Source& source : sources_) {
        if (!asked.empty() && asked.back()->class_name == source.class_name) continue;
        asked.push_back(&source);
        classes.push_back(learnt_from(source, arm, objects_.size(), {}));
    }
    moderate_thresholds(classes);
    fmt::print("\n## Made strangers, {}\n\n", known_of_parts.at(arm));
    Table table(" | answer | accepted by | undecided | nearest | unlike it | off it %");
    for (const ClassObject& object : made) {
        std::vector<ClassAnswer> list;
        int members = 0, open = 0;
        for (std::size_t k = 0; k < classes.size(); ++k) {
            const ClassTemplate known{{asked[k]->mesh, arm == 0 ? none_ : asked[k]->parts}, no_graph_};
            list.push_back(compare_with(classes[k], learn_member(known, object.member, how_, &object.whole)));
            members += list.back().verdict == Membership::member ? 1 : 0;
            open += list.back().verdict == Membership::undecided ? 1 : 0;
        }
        const Classification answer = decide(object.member.name, std::move(list));
        const ClassAnswer& near = answer.answers[static_cast<std::size_t>(answer.nearest)];
        table.row("{} | {} | {} | {} | {} | {:.2f} | {:.0f}", object.member.name, to_string(answer.verdict), members, open,
                  near.name, near.unlike.value_or(-1), 100 * near.fit.residuals->off());
    }
}

/// Every second class, sorted by name.
std::set<std::string> LeaveOneOut::first_half() const {
    std::set<std::string> half;
    bool take = true;
    for (const auto& [name, list] : objects_of_class_) {
        if (take) half.insert(name);
        take = !take;
    }
    return half;
}

std::set<std::string> LeaveOneOut::rest(const std::set<std::string>& half) const {
    std::set<std::string> others;
    for (const auto& [name, list] : objects_of_class_)
        if (half.count(name) == 0) others.insert(name);
    return others;
}

}  // namespace ostraka::experiments
