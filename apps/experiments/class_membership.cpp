// Classes of a benchmark learnt from members by fits of one template each; every object answered by classes that do not know it.
#include "classes.h"
#include "report.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/shape_classes/classify.h"
#include "ostraka/shape_classes/unlikeness.h"
#include "ostraka/stats/scores.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <set>

namespace ostraka::experiments {

namespace {

struct Object {
    std::string class_name;
    WholeObject member;
    WholeShape whole;
    Mesh original;
    std::vector<std::int32_t> labels;
};

/// Of the segmentations that people made of a model the one that agrees best with the others: greatest mean adjusted Rand index.
std::vector<std::int32_t> typical_labels(const Path& folder, const Mesh& mesh) {
    std::map<std::string, Path> files;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (extension(entry.path()) == ".seg") files[entry.path().filename().string()] = entry.path();
    if (files.empty()) fail_input(folder.string(), "has no .seg", "unpack the archive of labels there");
    std::vector<std::vector<int>> lists;
    for (const auto& [name, file] : files) lists.push_back(read_labels(file, mesh.number_of_faces()));
    std::size_t best = 0;
    double maximum = -2 * static_cast<double>(lists.size());
    for (std::size_t i = 0; i < lists.size(); ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < lists.size(); ++j) sum += i == j ? 0 : adjusted_rand_index(lists[i], lists[j]);
        if (sum > maximum) maximum = sum, best = i;
    }
    return lists[best];
}

/// A region for each connected part of a label that has half a per cent of the surface; less is not seen on a simplified mesh.
AnnotationSet parts_by_label(const Mesh& mesh, const std::vector<std::int32_t>& labels) {
    constexpr double minimum = 0.005;
    AnnotationSet set;
    std::vector<bool> seen(mesh.number_of_faces());
    const double area = surface_area(mesh);
    for (const Face seed : mesh.faces()) {
        if (seen[seed]) continue;
        std::vector<Face> front{seed};
        seen[seed] = true;
        double own = 0;
        Annotation part;
        for (std::size_t i = 0; i < front.size(); ++i) {
            own += face_area(mesh, front[i]);
            part.faces.push_back(front[i].idx());
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(front[i]))) {
                const Halfedge o = mesh.opposite(h);
                if (mesh.is_border(o)) continue;
                const Face next = mesh.face(o);
                if (!seen[next] && labels[next] == labels[seed]) seen[next] = true, front.push_back(next);
            }
        }
        if (own < minimum * area) continue;
        std::sort(part.faces.begin(), part.faces.end());
        part.id = static_cast<int>(set.annotations.size());
        part.tag = "piece";
        set.annotations.push_back(std::move(part));
    }
    return set;
}

AnnotationSet parts_on(const Mesh& mesh, const Mesh& labelled, const std::vector<std::int32_t>& labels) {
    const SurfaceSearch search(labelled);
    std::vector<std::int32_t> own;
    for (const Face face : mesh.faces()) own.push_back(labels[search.closest(centroid(mesh, face)).face]);
    return parts_by_label(mesh, own);
}

/// <class>/<number>.off, by class and number.
std::vector<Object> read_objects(const std::string& folder, std::size_t maximum) {
    std::map<std::string, std::map<int, Path>> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (extension(entry.path()) == ".off")
            files[entry.path().parent_path().filename().string()][std::stoi(entry.path().stem().string())] = entry.path();
    std::vector<Object> objects;
    for (const auto& [class_name, list] : files) {
        std::size_t taken = 0;
        for (const auto& [number, file] : list) {
            if (taken++ == maximum) break;
            Object object;
            object.class_name = class_name;
            object.member.name = class_name + " " + std::to_string(number);
            object.member.mesh = read_mesh(file).mesh;
            objects.push_back(std::move(object));
        }
    }
    if (objects.empty()) fail_input(folder, "has no <class>/<number>.off", "unpack the archive of models there");
    return objects;
}

Mesh simplified(const Mesh& mesh, std::uint64_t vertices) {
    Mesh small = mesh;
    if (mesh.number_of_vertices() <= vertices) return small;
    SimplifyOptions options;
    options.vertices = vertices;
    static_cast<void>(simplify(small, options));
    return small;
}

/// A class's template, made from one object, and what is measured where it lies on the others.
struct Source {
    std::string class_name;
    std::size_t object = 0;
    Mesh mesh;
    AnnotationSet parts;
    std::map<std::size_t, MemberFit> fits;                        ///< by object
    std::array<std::map<std::size_t, LearntMember>, 3> measured;  ///< by what is known, then by object
};

const std::array<const char*, 3> known_of_parts{"no annotations", "annotations of the template, laid on by the fit",
                                                "annotations of the template and of the objects"};

/// How the classes are learnt and asked.
struct Way {
    bool shared = true;     ///< the classes moderate each other's deviations
    bool strangers = true;  ///< objects of other classes say up to where one is recognised
    bool strict = false;    ///< of ClassifyOptions
    std::size_t members = 1000;
    double accept = 0.05;  ///< of LearnOptions
    [[nodiscard]] std::string file() const {
        return std::string(shared ? "" : "-alone") + (strangers ? "" : "-members") + (strict ? "-strict" : "") +
               (members < 1000 ? "-of" + std::to_string(members) : "");
    }
    [[nodiscard]] std::string text() const {
        return std::string(shared ? "" : "; each class by its own members' deviations alone") +
               (strangers ? "" : "; without strangers") +
               (strict ? "; the template has to lie on the object by the fixed limit" : "") +
               (members < 1000 ? "; of " + std::to_string(members) + " members" : "");
    }
};

using Counts = std::map<std::string, std::map<std::string, int>>;

void print(const Counts& table, const std::vector<std::string>& columns) {
    std::cout << "| |";
    for (const std::string& name : columns) std::cout << ' ' << name << " |";
    std::cout << "\n|---|";
    for (std::size_t k = 0; k < columns.size(); ++k) std::cout << "--:|";
    std::cout << '\n';
    for (const auto& [class_name, row] : table) {
        std::cout << "| " << class_name << " |";
        for (const std::string& name : columns) {
            const auto found = row.find(name);
            std::cout << ' ' << (found == row.end() ? "" : std::to_string(found->second)) << " |";
        }
        std::cout << '\n';
    }
}

/// A closed surface of a grid of `rings` x `sides` points; both ways around it closes (a torus), or only one, and its first and
/// last ring are points (a ball).
template <class At>
Object made_of_grid(const char* name, Index rings, Index sides, bool torus, At&& at) {
    TriangleSoup soup;
    const Index rows = torus ? rings : rings - 1;
    for (Index i = 0; i < rows; ++i)
        for (Index j = 0; j < sides; ++j) {
            const double u = torus ? static_cast<double>(i) / rings : static_cast<double>(i + 1) / rings;
            const Eigen::Vector3d p = at(u, static_cast<double>(j) / sides);
            soup.points.push_back({p.x(), p.y(), p.z()});
        }
    const auto index = [&](Index i, Index j) { return (torus ? i % rings : i) * sides + j % sides; };
    for (Index i = 0; i + (torus ? 0 : 1) < rows; ++i)
        for (Index j = 0; j < sides; ++j) {
            soup.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            soup.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    if (!torus)
        for (const bool last : {false, true}) {
            const Eigen::Vector3d p = at(last ? 1 : 0, 0);
            const auto pole = static_cast<Index>(soup.points.size());
            soup.points.push_back({p.x(), p.y(), p.z()});
            for (Index j = 0; j < sides; ++j) {
                const Index a = index(last ? rows - 1 : 0, j), b = index(last ? rows - 1 : 0, j + 1);
                if (last) soup.triangles.push_back({a, pole, b});
                else soup.triangles.push_back({pole, a, b});
            }
        }
    Object object;
    object.member.name = name;
    object.member.mesh = build_mesh(soup);
    object.whole = measure_whole_shape(object.member.mesh);
    return object;
}

/// Of a round section about a closed curve, given with its parameter from 0 to 1.
template <class Curve>
Object tube(const char* name, double radius, Curve&& curve) {
    return made_of_grid(name, 150, 16, true, [&](double u, double v) {
        constexpr double step = 1e-4;
        const Eigen::Vector3d along = (curve(u + step) - curve(u - step)).normalized();
        const Eigen::Vector3d across =
            along
                .cross(curve(u).squaredNorm() > 1e-12 && std::abs(along.z()) > 0.99 ? Eigen::Vector3d::UnitX()
                                                                                    : Eigen::Vector3d::UnitZ())
                .normalized();
        const double angle = -2 * pi * v;  // faces look outward
        return Eigen::Vector3d(curve(u) + radius * (std::cos(angle) * across + std::sin(angle) * along.cross(across)));
    });
}

/// A distance from the middle in every direction.
template <class Radius>
Object star_shaped(const char* name, Radius&& radius) {
    return made_of_grid(name, 50, 60, false, [&](double u, double v) {
        const double polar = pi * u, around = 2 * pi * v;
        const Eigen::Vector3d way(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar));
        return Eigen::Vector3d(radius(way).cwiseProduct(way));
    });
}

std::vector<Object> made_strangers() {
    using Eigen::Vector3d;
    std::vector<Object> made;
    const auto knot = [](double p, double q) {
        return [p, q](double u) {
            const double t = 2 * pi * u, r = 2 + std::cos(q * t);
            return Vector3d(r * std::cos(p * t), r * std::sin(p * t), -std::sin(q * t));
        };
    };
    made.push_back(tube("knot", 0.4, knot(2, 3)));
    made.push_back(tube("knot of five", 0.3, knot(2, 5)));
    made.push_back(tube("torus", 0.7, [](double u) { return Vector3d(2 * std::cos(2 * pi * u), 2 * std::sin(2 * pi * u), 0); }));
    made.push_back(star_shaped("ball", [](const Vector3d&) { return Vector3d(1, 1, 1); }));
    made.push_back(star_shaped("rod", [](const Vector3d&) { return Vector3d(1, 1, 8); }));
    made.push_back(star_shaped("disc", [](const Vector3d&) { return Vector3d(4, 4, 0.5); }));
    made.push_back(star_shaped("star", [](const Vector3d& way) {
        const double r = 1 + 1.5 * std::pow(std::abs(way.x() * way.x() * way.x()) + std::abs(way.y() * way.y() * way.y()) +
                                                std::abs(way.z() * way.z() * way.z()),
                                            4);
        return Vector3d(r, r, r);
    }));
    return made;
}

class LeaveOneOut {
public:
    LeaveOneOut(const std::vector<Object>& objects, const ClassMembershipOptions& options) : objects_(objects) {
        for (std::size_t i = 0; i < objects.size(); ++i) objects_of_class_[objects[i].class_name].push_back(i);
        how_.correspondence = CorrespondenceChoice::fitted;
        how_.fit.tries = options.tries;
        how_.fit.fit.search_radius = options.search_radius;
        how_.fit.fit.levels = 5;
        how_.fit.fit.steps = 2;
        how_.fit.alignment.samples = 400;
    }

    /// The second template of a class answers for the object that the first one was made from.
    void fit(const ClassMembershipOptions& options) {
        std::ofstream csv(Path(options.output) / "quantities.csv");
        csv << "template,object,annotations,kind,id,name,value\n";
        std::vector<double> seconds;
        for (const auto& [class_name, list] : objects_of_class_)
            for (std::size_t first = 0; first < std::min<std::size_t>(2, list.size()); ++first) {
                Source& source = sources_.emplace_back();
                source.class_name = class_name;
                source.object = list[first];
                const Object& from = objects_[source.object];
                source.mesh = simplified(from.member.mesh, options.template_vertices);
                if (!from.labels.empty()) source.parts = parts_on(source.mesh, from.original, from.labels);
                for (std::size_t i = 0; i < objects_.size(); ++i) {
                    // The second one needs strangers for its limits, and a third of them says enough.
                    const bool own = objects_[i].class_name == class_name;
                    if (i == source.object || (first > 0 && !own && i % 3 != 0)) continue;
                    const Stopwatch watch;
                    const WholeObject bare{objects_[i].member.name, objects_[i].member.mesh, {}};
                    source.fits[i] = fit_member(source.mesh, {}, bare, how_.fit);
                    seconds.push_back(watch.seconds().processor);
                    measure(source, i);
                    for (int arm = 0; arm < 3; ++arm)
                        for (const ClassQuantity& one : source.measured.at(static_cast<std::size_t>(arm))[i].quantities)
                            if (one.value)
                                csv << from.member.name << ',' << bare.name << ',' << arm << ',' << to_string(one.kind) << ','
                                    << one.id << ',' << one.name << ',' << format("%.6g", *one.value) << '\n';
                    csv << std::flush;
                }
            }
        std::cout << seconds.size() << " fits, " << format("%.2f", upper_median(seconds)) << " s each (median)\n";
    }

    /// Every object asked of classes that do not know it.
    void ask(std::size_t arm, const Way& way, const ClassMembershipOptions& options) const {
        Counts nearest, decided;
        std::map<std::string, int> sums;
        std::size_t near = 0, own_refused = 0, own_recognised = 0, accepted = 0, asked = 0, open = 0;
        std::ofstream answers(Path(options.output) / ("answers-" + std::to_string(arm) + way.file() + ".csv"));
        answers << "object,class,verdict,score,unlike,off,against,first reason\n";
        std::vector<Asked> curve;
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            const Object& object = objects_[i];
            std::vector<ClassAnswer> list = answers_of(i, arm, way);
            bool any_other = false;
            for (const ClassAnswer& one : list) {
                const bool member = one.verdict == Membership::member;
                const auto reasons = one.reasons();
                answers << object.member.name << ',' << one.name << ',' << to_string(one.verdict) << ','
                        << format("%.4f", one.score) << ',' << format("%.4f", one.unlike.value_or(-1)) << ','
                        << format("%.4f", one.fit.residuals ? one.fit.residuals->off() : 0) << ',' << one.against.size() << ",\""
                        << (reasons.empty() ? one.undecided : reasons.front()) << "\"\n";
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
        std::cout << "\n## " << known_of_parts.at(arm) << way.text() << "\n\nNearest class: " << near << " of " << n
                  << " right.\n\n";
        std::vector<std::string> columns;
        for (const auto& [class_name, list] : objects_of_class_) columns.push_back(class_name);
        print(nearest, columns);
        std::cout << "\nAnswers: " << sums["right"] << " right, " << sums["wrong"] << " wrong, " << sums["none"] << " none, "
                  << sums["undecided"] << " undecided. Its own class recognises " << own_recognised << " of " << n
                  << " objects and refuses " << own_refused << "; another one accepts one " << accepted << " times in " << asked
                  << "; without its own class " << open << " of " << n << " objects are accepted by one or more.\n\n";
        columns.emplace_back("none");
        columns.emplace_back("undecided");
        print(decided, columns);
        print_curve(curve, "all classes", {});
        if (const auto half = first_half(); half.size() > 1) {
            print_curve(curve, "the classes that choices were made on", half);
            print_curve(curve, "the other classes", rest(half));
        }
    }

    /// What is recognised and what is accepted as the share of strangers that may be accepted rises.
    void ask_at_rates(std::size_t arm) const {
        std::cout << "\n## Limits by strangers, " << known_of_parts.at(arm)
                  << "\n\n| members | accept % | recognised % | refused % | accepted by a class % | by any % | tuned on: "
                     "recognised, by a "
                     "class, by any | others |\n|--:|--:|--:|--:|--:|--:|--:|--:|\n";
        const std::set<std::string> half = first_half(), others = rest(half);
        for (const std::size_t members : {3UL, 1000UL})
            for (const double accept : {0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5}) {
                Way way;
                way.members = members;
                way.accept = accept;
                Rates all, tuned, judged;
                for (std::size_t i = 0; i < objects_.size(); ++i) {
                    const std::string& of = objects_[i].class_name;
                    const std::vector<ClassAnswer> list = answers_of(i, arm, way);
                    all.add(list, of, {});
                    if (half.count(of) > 0) tuned.add(list, of, half);
                    else judged.add(list, of, others);
                }
                std::cout << "| " << (members < 1000 ? std::to_string(members) : "4 or 5") << " | "
                          << format("%.0f", 100 * accept) << " | " << share(all.recognised, all.objects) << " | "
                          << share(all.refused, all.objects) << " | " << share(all.accepted, all.asked) << " | "
                          << share(all.open, all.objects) << " | " << tuned.text() << " | " << judged.text() << " |\n";
            }
    }

    /// Objects of no class, made by rule, asked of all classes with all their members.
    void ask_made(const std::vector<Object>& made, std::size_t arm) const {
        std::vector<ShapeClass> classes;
        std::vector<const Source*> asked;
        for (const Source& source : sources_) {
            if (!asked.empty() && asked.back()->class_name == source.class_name) continue;
            asked.push_back(&source);
            classes.push_back(learnt_from(source, arm, objects_.size(), {}));
        }
        moderate_thresholds(classes);
        std::cout
            << "\n## Made strangers, " << known_of_parts.at(arm)
            << "\n\n| | answer | accepted by | undecided | nearest | unlike it | off it % |\n|---|---|--:|--:|---|--:|--:|\n";
        for (const Object& object : made) {
            std::vector<ClassAnswer> list;
            int members = 0, open = 0;
            for (std::size_t k = 0; k < classes.size(); ++k) {
                const ClassTemplate known{asked[k]->mesh, arm == 0 ? none_ : asked[k]->parts, no_graph_};
                list.push_back(compare_with(classes[k], learn_member(known, object.member, how_, &object.whole)));
                members += list.back().verdict == Membership::member ? 1 : 0;
                open += list.back().verdict == Membership::undecided ? 1 : 0;
            }
            const Classification answer = decide(object.member.name, std::move(list));
            const ClassAnswer& near = answer.answers[static_cast<std::size_t>(answer.nearest)];
            std::cout << "| " << object.member.name << " | " << to_string(answer.verdict) << " | " << members << " | " << open
                      << " | " << near.name << " | " << format("%.2f", near.unlike.value_or(-1)) << " | "
                      << format("%.0f", 100 * near.fit.residuals->off()) << " |\n";
        }
    }

private:
    void measure(Source& source, std::size_t i) {
        const WholeObject& with = objects_[i].member;
        const WholeObject bare{with.name, with.mesh, {}};
        const MemberFit& fit = source.fits.at(i);
        const ClassTemplate plain{source.mesh, none_, no_graph_}, known{source.mesh, source.parts, no_graph_};
        source.measured[0][i] = measure_member(plain, bare, fit, how_, &objects_[i].whole);
        source.measured[1][i] = measure_member(known, bare, fit, how_, &objects_[i].whole);
        source.measured[2][i] = measure_member(known, with, fit, how_, &objects_[i].whole);
    }

    /// What every class that does not know the object says of it.
    [[nodiscard]] std::vector<ClassAnswer> answers_of(std::size_t i, std::size_t arm, const Way& way) const {
        std::vector<const Source*> asked;
        std::vector<ShapeClass> classes;
        for (const auto& [class_name, members] : objects_of_class_)
            for (const Source& source : sources_)
                if (source.class_name == class_name && source.object != i) {
                    asked.push_back(&source);
                    classes.push_back(learnt_from(source, arm, i, way));
                    break;
                }
        for (ShapeClass& one : classes) {
            one.accept = way.accept;
            learn_thresholds(one);
        }
        if (way.shared) moderate_thresholds(classes);
        ClassifyOptions how;
        how.strict = way.strict;
        std::vector<ClassAnswer> list;
        for (std::size_t k = 0; k < classes.size(); ++k)
            list.push_back(compare_with(classes[k], asked[k]->measured.at(arm).at(i), how));
        return list;
    }

    /// Strangers are objects of the other classes, but none of the class of the object that will be asked: it is of a kind
    /// unseen.
    [[nodiscard]] ShapeClass learnt_from(const Source& source, std::size_t arm, std::size_t without, const Way& way) const {
        std::vector<LearntMember> members, strangers;
        const std::string of = without < objects_.size() ? objects_[without].class_name : "";
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            const auto found = source.measured.at(arm).find(i);
            if (i == without || found == source.measured.at(arm).end()) continue;
            const LearntMember& one = found->second;
            if (objects_[i].class_name == source.class_name) {
                if (members.size() < way.members) members.push_back(one);
            } else if (way.strangers && objects_[i].class_name != of) {
                strangers.push_back(one);
            }
        }
        ShapeClass learnt = learn_class({source.mesh, arm == 0 ? none_ : source.parts, no_graph_}, members, how_, strangers);
        learnt.name = source.class_name;
        return learnt;
    }

    static std::string share(std::size_t part, std::size_t all) {
        return all == 0 ? "-" : format("%.1f", 100.0 * static_cast<double>(part) / static_cast<double>(all));
    }
    struct Rates {
        std::size_t objects = 0, recognised = 0, refused = 0, asked = 0, accepted = 0, open = 0;
        void add(const std::vector<ClassAnswer>& list, const std::string& of, const std::set<std::string>& only) {
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
        [[nodiscard]] std::string text() const {
            return share(recognised, objects) + ", " + share(accepted, asked) + ", " + share(open, objects);
        }
    };

    /// An object asked of a class: how unlike it is, infinite where anything else speaks against it.
    struct Asked {
        std::string object_class;
        std::size_t object;
        std::string asked;
        double unlike;
    };
    static double unlike_where_nothing_else_speaks(const ClassAnswer& answer) {
        const bool against = std::any_of(answer.against.begin(), answer.against.end(),
                                         [&](std::size_t k) { return answer.checks[k].quantity.name != unlike_the_members; });
        return against || !answer.off.empty() || !answer.unlike ? std::numeric_limits<double>::infinity() : *answer.unlike;
    }

    /// Accepted strangers against recognised members, as the limit of unlikeness, one for all classes, rises.
    static void print_curve(const std::vector<Asked>& points, const char* title, const std::set<std::string>& only) {
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
        std::cout << "\nAccepted against recognised, " << title
                  << ":\n\n| recognised % | limit | accepted by a class % | by any % |\n"
                  << "|--:|--:|--:|--:|\n";
        for (const int per_cent : {50, 60, 70, 75, 80, 85, 90, 95}) {
            const std::size_t k = (own.size() * static_cast<std::size_t>(per_cent) + 99) / 100;
            const double limit = own[std::max<std::size_t>(1, k) - 1];
            if (!std::isfinite(limit)) break;
            const auto share = [&](const auto& list, const auto& value) {
                return format("%.1f", 100.0 *
                                          static_cast<double>(std::count_if(
                                              list.begin(), list.end(), [&](const auto& one) { return value(one) <= limit; })) /
                                          static_cast<double>(list.size()));
            };
            std::cout << "| " << per_cent << " | " << format("%.2f", limit) << " | " << share(others, [](double x) { return x; })
                      << " | " << share(nearest, [](const auto& x) { return x.second; }) << " |\n";
        }
    }

    /// Every other class, in the order of their names.
    [[nodiscard]] std::set<std::string> first_half() const {
        std::set<std::string> half;
        bool take = true;
        for (const auto& [name, list] : objects_of_class_) {
            if (take) half.insert(name);
            take = !take;
        }
        return half;
    }
    [[nodiscard]] std::set<std::string> rest(const std::set<std::string>& half) const {
        std::set<std::string> others;
        for (const auto& [name, list] : objects_of_class_)
            if (half.count(name) == 0) others.insert(name);
        return others;
    }

    const std::vector<Object>& objects_;
    std::map<std::string, std::vector<std::size_t>> objects_of_class_;
    std::vector<Source> sources_;
    LearnOptions how_;
    const AnnotationSet none_;
    const RelationGraph no_graph_;
};

}  // namespace

void class_membership(const ClassMembershipOptions& options) {
    std::vector<Object> objects = read_objects(options.models, options.members);
    for (Object& object : objects) {
        object.whole = measure_whole_shape(object.member.mesh);
        object.original = object.member.mesh;
        object.member.mesh = simplified(object.original, options.object_vertices);
        if (options.labels.empty()) continue;
        const std::string number = object.member.name.substr(object.class_name.size() + 1);
        object.labels = typical_labels(Path(options.labels) / object.class_name / number, object.original);
        object.member.annotations = parts_on(object.member.mesh, object.original, object.labels);
    }
    std::filesystem::create_directories(options.output);
    LeaveOneOut membership(objects, options);
    membership.fit(options);
    const std::vector<Object> made = made_strangers();
    for (std::size_t arm = 0; arm < (options.labels.empty() ? 1 : 3); ++arm) {
        for (const Way& way :
             {Way{}, Way{true, false}, Way{false, true}, Way{false, false}, Way{true, true, true}, Way{true, true, false, 3}})
            membership.ask(arm, way, options);
        membership.ask_made(made, arm);
        if (arm == 0) membership.ask_at_rates(arm);
    }
}

}  // namespace ostraka::experiments
