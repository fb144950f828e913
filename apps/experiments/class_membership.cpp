// Classes of a benchmark learnt from members by fits of one template each; every object answered by classes that do not know it.
#include "classes.h"
#include "report.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/family/classify.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/simplify.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

namespace ostraka::experiments {

namespace {

struct Object {
    std::string family;
    WholeObject member;
    WholeShape whole;
};

/// <class>/<number>.off, by class and number.
std::vector<Object> read_objects(const std::string& folder, std::size_t most) {
    std::map<std::string, std::map<int, Path>> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (extension(entry.path()) == ".off")
            files[entry.path().parent_path().filename().string()][std::stoi(entry.path().stem().string())] = entry.path();
    std::vector<Object> objects;
    for (const auto& [family, list] : files) {
        std::size_t taken = 0;
        for (const auto& [number, file] : list) {
            if (taken++ == most) break;
            Object object{family, {}, {}};
            object.member.name = family + " " + std::to_string(number);
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

/// A class's template, made from one object, and how it fits all others.
struct Source {
    std::string family;
    std::size_t object = 0;
    Mesh mesh;
    std::map<std::size_t, LearntMember> fits;  ///< by object
};

}  // namespace

void class_membership(const ClassMembershipOptions& options) {
    std::vector<Object> objects = read_objects(options.models, options.members);
    for (Object& object : objects) {
        object.whole = measure_whole_shape(object.member.mesh);
        object.member.mesh = simplified(object.member.mesh, options.object_vertices);
    }
    std::map<std::string, std::vector<std::size_t>> families;
    for (std::size_t i = 0; i < objects.size(); ++i) families[objects[i].family].push_back(i);
    const AnnotationSet no_annotations;
    const RelationGraph no_graph;
    LearnOptions how;
    how.correspondence = "fitted";
    how.fit.tries = options.tries;
    how.fit.fit.reach = options.reach;
    how.fit.fit.levels = 5;
    how.fit.fit.steps = 2;
    how.fit.alignment.samples = 400;

    std::vector<Source> sources;
    std::filesystem::create_directories(options.output);
    std::ofstream csv(Path(options.output) / "fits.csv");
    csv << "template,object,distance,back,unmatched,unexplained,stretch,bend,compactness,geodesic mean,geodesic most,geodesic "
           "variation,scale,placed,seconds\n";
    for (const auto& [family, list] : families)
        for (std::size_t first = 0; first < std::min<std::size_t>(2, list.size()); ++first) {
            // The second template answers for the object that the first one was made from.
            Source& source = sources.emplace_back();
            source.family = family;
            source.object = list[first];
            source.mesh = simplified(objects[source.object].member.mesh, options.template_vertices);
            const ClassTemplate known{source.mesh, no_annotations, no_graph};
            for (std::size_t i = 0; i < objects.size(); ++i) {
                if (i == source.object || (first > 0 && objects[i].family != family)) continue;
                const Stopwatch watch;
                source.fits[i] = learn_member(known, objects[i].member, how, &objects[i].whole);
                const LearntMember& fit = source.fits[i];
                csv << objects[source.object].member.name << ',' << objects[i].member.name << ',';
                for (const ClassQuantity& quantity : fit.quantities) csv << format("%.5f,", quantity.value.value_or(-1));
                csv << format("%.4f,%.4f,%.2f\n", fit.fit.scale, fit.fit.share_placed, watch.seconds().processor) << std::flush;
            }
        }

    const auto learnt_from = [&](const Source& source, std::size_t without) {
        std::vector<LearntMember> members;
        for (const std::size_t i : families[source.family])
            if (i != without && i != source.object) members.push_back(source.fits.at(i));
        ShapeClass learnt = learn_class({source.mesh, no_annotations, no_graph}, members, how);
        learnt.name = source.family;
        return learnt;
    };
    std::map<std::string, std::map<std::string, int>> nearest, decided;
    std::size_t right_nearest = 0, right_decided = 0, wrong_decided = 0, none = 0, undecided = 0, own_rejected = 0,
                others_accepted = 0, others_asked = 0;
    std::ofstream answers(Path(options.output) / "answers.csv");
    answers << "object,class,verdict,score,first reason\n";
    for (std::size_t i = 0; i < objects.size(); ++i) {
        std::vector<ClassAnswer> list;
        for (const auto& [family, members] : families) {
            const auto source = std::find_if(sources.begin(), sources.end(), [&, &family = family](const Source& one) {
                return one.family == family && one.object != i;
            });
            if (source == sources.end() || source->fits.count(i) == 0) continue;
            list.push_back(compare_with(learnt_from(*source, i), source->fits.at(i)));
            const auto reasons = list.back().reasons();
            answers << objects[i].member.name << ',' << family << ',' << to_string(list.back().verdict) << ','
                    << format("%.4f", list.back().score) << ",\"" << (reasons.empty() ? "" : reasons.front()) << "\"\n";
            if (family == objects[i].family) {
                own_rejected += list.back().verdict != Membership::member ? 1 : 0;
            } else {
                ++others_asked;
                others_accepted += list.back().verdict == Membership::member ? 1 : 0;
            }
        }
        const Classification answer = decide(objects[i].member.name, std::move(list));
        const std::string& truth = objects[i].family;
        const std::string near = answer.nearest < 0 ? "-" : answer.answers[static_cast<std::size_t>(answer.nearest)].name;
        const std::string best = answer.best >= 0 ? answer.answers[static_cast<std::size_t>(answer.best)].name
                                 : answer.verdict == Membership::other ? "none"
                                                                       : "undecided";
        ++nearest[truth][near];
        ++decided[truth][best];
        right_nearest += near == truth ? 1 : 0;
        right_decided += best == truth ? 1 : 0;
        none += best == "none" ? 1 : 0;
        undecided += best == "undecided" ? 1 : 0;
        wrong_decided += best != truth && answer.best >= 0 ? 1 : 0;
    }
    const auto print = [&](const std::map<std::string, std::map<std::string, int>>& table, bool refusals) {
        std::cout << "| |";
        for (const auto& [family, list] : families) std::cout << ' ' << family << " |";
        std::cout << (refusals ? " none | undecided |" : "") << "\n|---|";
        for (std::size_t k = 0; k < families.size() + (refusals ? 2 : 0); ++k) std::cout << "--:|";
        std::cout << '\n';
        for (const auto& [family, row] : table) {
            std::cout << "| " << family << " |";
            const auto cell = [&, &row = row](const std::string& name) {
                const auto found = row.find(name);
                std::cout << ' ' << (found == row.end() ? "" : std::to_string(found->second)) << " |";
            };
            for (const auto& [other, list] : families) cell(other);
            if (refusals) cell("none"), cell("undecided");
            std::cout << '\n';
        }
    };
    const auto n = objects.size();
    std::cout << "Nearest class, leave one out: " << right_nearest << " of " << n << " right\n\n";
    print(nearest, false);
    std::cout << "\nWith thresholds: " << right_decided << " right, " << wrong_decided << " wrong, " << none << " none, "
              << undecided << " undecided; own class refused " << own_rejected << " of " << n << " times, another accepted "
              << others_accepted << " of " << others_asked << "\n\n";
    print(decided, true);
}

}  // namespace ostraka::experiments
