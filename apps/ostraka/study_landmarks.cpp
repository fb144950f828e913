// ostraka study landmarks: shapes of landmarks laid over each other, their mean and how they vary.
#include "commands.h"
#include "study.h"

#include "ostraka/exchange/landmarks.h"
#include "ostraka/registration/procrustes.h"
#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"
#include "ostraka/stats/embedding.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <set>

namespace ostraka::app {

namespace {

Json landmarks_json(const CollectionObject& object) {
    if (object.landmarks.empty()) fail_input(object.name, "there are no landmarks", "put NAME.mrk.json beside the mesh");
    const LandmarkSet set = read_landmarks(object.landmarks, LandmarkFormat::mrk);
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    JsonValue names(rapidjson::kArrayType), places(rapidjson::kArrayType);
    std::set<std::string> seen;
    for (const Landmark& landmark : set.landmarks) {
        if (!seen.insert(landmark.name).second)
            fail_input(object.landmarks.string(), "two landmarks are called '" + landmark.name + "'",
                       "give each a name of its own");
        names.PushBack(json_string(landmark.name, allocator), allocator);
        for (const double c : landmark.position) places.PushBack(c, allocator);
    }
    add_member(document, "unit", set.unit, allocator);
    add_member(document, "names", std::move(names), allocator);
    add_member(document, "places", std::move(places), allocator);
    return document;
}

/// Objects with the landmarks that all of them have.
struct Shapes {
    std::vector<std::string> objects, labels, names, units;
    std::vector<Landmarks> configurations;
};

struct StudyLandmarks {
    StudyFiles files;
    int components = 5;
    ProcrustesOptions options;

    int run(const Session& session) const {
        Provenance provenance{"study landmarks", list_options(options), {}};
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        const Collection collection = files.read(session, provenance);
        const std::vector<ObjectResult> read =
            for_each_object(collection, files.store("landmarks"), {"landmarks"}, landmarks_json);
        report_failures(session, collection, read, result, allocator);
        std::vector<std::string> notes;
        const Shapes shapes = common(collection, read, notes);
        const GeneralisedProcrustes shape = generalised_procrustes(shapes.configurations, options);
        if (!shape.converged)
            notes.emplace_back("the mean had not settled after " + std::to_string(shape.iterations) + " iterations");
        for (const auto& note : notes) session.note("note: " + note);
        const PrincipalComponents principal = principal_components(shape_rows(shape.aligned), components);

        write(shapes, shape, principal, provenance);
        const Summary sizes = summarise(shape.centroid_sizes, "centroid sizes");
        add_member(result, "objects", JsonValue(static_cast<std::uint64_t>(shapes.objects.size())), allocator);
        KnownAnswers(shapes.labels).add_to(result, allocator);
        add_member(result, "landmarks", JsonValue(static_cast<std::uint64_t>(shapes.names.size())), allocator);
        add_member(result, "meanCentroidSize", JsonValue(sizes.mean), allocator);
        add_member(result, "meanNorm", JsonValue(shape.mean.norm()), allocator);
        add_member(result, "sumOfSquares", JsonValue(shape.sum_of_squares), allocator);
        add_member(result, "iterations", JsonValue(shape.iterations), allocator);
        add_member(result, "converged", JsonValue(shape.converged), allocator);
        JsonValue shares(rapidjson::kArrayType), list(rapidjson::kArrayType);
        for (const double variance : principal.variances)
            shares.PushBack(principal.total_variance > 0 ? variance / principal.total_variance : 0, allocator);
        add_member(result, "components", std::move(shares), allocator);
        for (const auto& note : notes) list.PushBack(json_string(note, allocator), allocator);
        add_member(result, "notes", std::move(list), allocator);
        if (session.json) {
            session.print_report(provenance, document, result);
        } else {
            const std::string unit = same_unit(shapes.units);
            TextTable table({"landmarks", "of", "mean centroid size", "size of the mean", "sum of squares"});
            table.add({std::to_string(shapes.names.size()), std::to_string(shapes.objects.size()) + " objects",
                       significant(sizes.mean, 10) + (unit.empty() ? "" : " " + unit), significant(shape.mean.norm(), 10),
                       significant(shape.sum_of_squares, 10)});
            std::cout << table.plain();
        }
        return done;
    }

private:
    static std::string same_unit(const std::vector<std::string>& units) {
        return std::all_of(units.begin(), units.end(), [&](const auto& unit) { return unit == units.front(); }) ? units.front()
                                                                                                                : "";
    }

    Shapes common(const Collection& collection, const std::vector<ObjectResult>& read, std::vector<std::string>& notes) const {
        Shapes shapes;
        std::map<std::string, std::size_t> counts;
        std::vector<std::map<std::string, std::array<double, 3>>> places;
        std::vector<std::string> order;
        for (std::size_t i = 0; i < read.size(); ++i) {
            if (!read[i].problem.empty()) continue;
            const Json& one = read[i].result;
            auto& of = places.emplace_back();
            for (rapidjson::SizeType k = 0; k < one["names"].Size(); ++k) {
                const std::string name = one["names"][k].GetString();
                for (rapidjson::SizeType c = 0; c < 3; ++c) of[name].at(c) = one["places"][3 * k + c].GetDouble();
                if (++counts[name] == 1) order.push_back(name);
            }
            shapes.objects.push_back(collection.objects[i].name);
            shapes.labels.push_back(collection.objects[i].label);
            const std::string unit = one["unit"].GetString();
            shapes.units.push_back(collection.objects[i].unit.empty() ? unit : collection.objects[i].unit);
        }
        if (places.empty())
            throw Error(ErrorKind::input, files.collection, "no object has landmarks that can be read",
                        "the first: " + read.front().problem);
        std::string lacking;
        for (const std::string& name : order) {
            if (counts.at(name) == places.size()) shapes.names.push_back(name);
            else lacking += (lacking.empty() ? "'" : ", '") + name + "'";
        }
        if (!lacking.empty()) notes.push_back("landmarks that not all objects have are left out: " + lacking);
        if (shapes.names.size() < 3)
            throw Error(ErrorKind::input, files.collection,
                        "the objects have " + std::to_string(shapes.names.size()) + " landmarks in common",
                        "at least three are needed");
        if (!options.scaling && std::set(shapes.units.begin(), shapes.units.end()).size() > 1)
            throw Error(ErrorKind::input, files.collection, "the landmarks have different units",
                        "give --scaling, or bring them to one unit");
        for (const auto& of : places) {
            Landmarks x(static_cast<Eigen::Index>(shapes.names.size()), 3);
            for (std::size_t k = 0; k < shapes.names.size(); ++k)
                for (std::size_t c = 0; c < 3; ++c)
                    x(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) = of.at(shapes.names[k])[c];
            shapes.configurations.push_back(std::move(x));
        }
        return shapes;
    }

    void write(const Shapes& shapes, const GeneralisedProcrustes& shape, const PrincipalComponents& principal,
               const Provenance& provenance) const {
        LandmarkSet mean;
        mean.unit = options.scaling ? "" : same_unit(shapes.units);
        for (std::size_t k = 0; k < shapes.names.size(); ++k) {
            const Eigen::RowVector3d p = shape.mean.row(static_cast<Eigen::Index>(k));
            mean.landmarks.push_back({shapes.names[k], {p.x(), p.y(), p.z()}, std::nullopt});
        }
        std::vector<std::string> unused;
        write_file(files.in("mean.mrk.json"), landmarks_to_text(mean, LandmarkFormat::mrk, "", provenance, unused));

        const int count = static_cast<int>(principal.scores.cols());
        std::vector<std::string> head{"object", "centroid size", "distance from the mean"};
        for (int c = 0; c < count; ++c) head.push_back("component " + std::to_string(c + 1));
        TextTable table(head);
        std::map<std::string, PlotSeries> classes;
        for (std::size_t i = 0; i < shapes.objects.size(); ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            std::vector<TableCell> cells{shapes.objects[i], number_cell(shape.centroid_sizes[i], 12),
                                         number_cell(std::sqrt(shape.maps[i].sum_of_squares), 10)};
            for (int c = 0; c < count; ++c) cells.push_back(number_cell(principal.scores(row, c), 10));
            table.add(cells);
            PlotSeries& series = classes[shapes.labels[i]];
            series.points.push_back({principal.scores(row, 0), count > 1 ? principal.scores(row, 1) : 0});
            series.labels.push_back(shapes.objects[i]);
        }
        table.write(files.output, "objects", "Landmarks: sizes, distances from the mean shape, principal components");
        const auto share = [&](int c) {
            return c < count && principal.total_variance > 0 ? ", " + percent(principal.variances[c] / principal.total_variance)
                                                             : "";
        };
        Plot plot{"Shapes of landmarks", {"first component" + share(0)}, {"second component" + share(1)}, {}};
        for (auto& [label, series] : classes) {
            series.name = label;
            series.joined = false;
            plot.series.push_back(series);
        }
        plot.equal = true;
        write_plot(files.plot("components"), plot);
    }
};

}  // namespace

void add_study_landmarks(CLI::App& study, Session& session) {
    const auto work = std::make_shared<StudyLandmarks>();
    CLI::App* command = session.add(study, "landmarks",
                                    "lay the landmarks of a collection over each other (generalised Procrustes analysis): mean "
                                    "shape, sizes, principal components",
                                    [&session, work] { return work->run(session); });
    add_study_files(command, work->files, true);
    command->add_option("--components", work->components, "principal components to write")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    add_flags(command, work->options);
}

}  // namespace ostraka::app
