// Classes of a benchmark learnt from members by fits of one template each; every object answered by classes that do not know it.
#include "classes.h"
#include "report.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/shape_classes/classify.h"
#include "ostraka/stats/scores.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

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
                    if (i == source.object || (first > 0 && objects_[i].class_name != class_name)) continue;
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

    /// Every object asked of classes that do not know it; with `shared` the classes moderate each other's deviations.
    void ask(std::size_t arm, bool shared, const ClassMembershipOptions& options) const {
        Counts nearest, decided;
        std::map<std::string, int> sums;
        std::size_t near = 0, own_refused = 0, accepted = 0, asked = 0, open = 0;
        std::ofstream answers(Path(options.output) / ("answers-" + std::to_string(arm) + (shared ? "" : "-alone") + ".csv"));
        answers << "object,class,verdict,score,first reason\n";
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            const Object& object = objects_[i];
            std::vector<const Source*> asked_of;
            std::vector<ShapeClass> classes;
            for (const auto& [class_name, members] : objects_of_class_)
                for (const Source& source : sources_)
                    if (source.class_name == class_name && source.object != i) {
                        asked_of.push_back(&source);
                        classes.push_back(learnt_from(source, arm, i));
                        break;
                    }
            if (shared) moderate_thresholds(classes);
            std::vector<ClassAnswer> list;
            bool any_other = false;
            for (std::size_t k = 0; k < classes.size(); ++k) {
                list.push_back(compare_with(classes[k], asked_of[k]->measured.at(arm).at(i)));
                const bool member = list.back().verdict == Membership::member;
                const auto reasons = list.back().reasons();
                answers << object.member.name << ',' << classes[k].name << ',' << to_string(list.back().verdict) << ','
                        << format("%.4f", list.back().score) << ",\"" << (reasons.empty() ? "" : reasons.front()) << "\"\n";
                if (classes[k].name == object.class_name) {
                    own_refused += member ? 0 : 1;
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
        std::cout << "\n## " << known_of_parts.at(arm) << (shared ? "" : "; each class by its own members' deviations alone")
                  << "\n\nNearest class: " << near << " of " << n << " right.\n\n";
        std::vector<std::string> columns;
        for (const auto& [class_name, list] : objects_of_class_) columns.push_back(class_name);
        print(nearest, columns);
        std::cout << "\nAnswers: " << sums["right"] << " right, " << sums["wrong"] << " wrong, " << sums["none"] << " none, "
                  << sums["undecided"] << " undecided. Its own class refuses an object " << own_refused << " times in " << n
                  << ", another one accepts it " << accepted << " times in " << asked << "; without its own class " << open
                  << " of " << n << " objects are accepted by one or more.\n\n";
        columns.emplace_back("none");
        columns.emplace_back("undecided");
        print(decided, columns);
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

    [[nodiscard]] ShapeClass learnt_from(const Source& source, std::size_t arm, std::size_t without) const {
        std::vector<LearntMember> members;
        for (const std::size_t i : objects_of_class_.at(source.class_name))
            if (i != without && i != source.object) members.push_back(source.measured.at(arm).at(i));
        ShapeClass learnt = learn_class({source.mesh, arm == 0 ? none_ : source.parts, no_graph_}, members, how_);
        learnt.name = source.class_name;
        return learnt;
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
    for (std::size_t arm = 0; arm < (options.labels.empty() ? 1 : 3); ++arm)
        for (const bool shared : {true, false}) membership.ask(arm, shared, options);
}

}  // namespace ostraka::experiments
