// ostraka template learn | classify
#include "template_class.h"
#include "template_landmarks.h"

#include "ostraka/core/text.h"
#include "ostraka/geom/with_points.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

namespace fs = std::filesystem;

struct Learn {
    std::vector<std::string> files;
    std::string output, name;
    LearnOptions options;
    bool given = false;

    int run(const Session& session) {
        if (given) options.correspondence = "given";
        check_options(options, "learn");
        if (!files.empty() && is_landmark_file(files[0])) return run_landmarks(session);
        if (files.size() < 2) fail_usage("the class is empty: there is no member", "give TEMPLATE MEMBER ...");
        const std::vector<std::string> members(files.begin() + 1, files.end());
        check_names(members);
        if (!name.empty()) check_class_name(name);
        check_folder(output);
        Provenance provenance{"template learn", list_options(options), {}};
        const LoadedTemplate loaded = load_class_template(files[0], provenance);
        if (name.empty()) name = loaded.file.object_class;
        if (name.empty()) {
            name = Path(files[0]).filename().string();
            const std::string ending = ".template.json";
            if (name.size() > ending.size() && name.ends_with(ending)) name.resize(name.size() - ending.size());
        }
        std::replace(name.begin(), name.end(), ' ', '-');
        check_class_name(name);
        std::vector<LearntMember> learnt;
        for (const std::string& file : members) {
            const WholeObject member = read_member(file, provenance);
            learnt.push_back(in_file(file, [&] { return learn_member(loaded.known(), member, options); }));
            session.note(printable(member.name) + ": " +
                         (learnt.back().fit.problem.empty() ? "laid on by " + learnt.back().fit.placed_by
                                                            : "left out: " + printable(learnt.back().fit.problem)));
            if (const std::string off = fit_is_off(learnt.back().fit, options.fit.most_off); !off.empty())
                session.note(printable(member.name) + ": " + off);
        }
        ShapeClass result = learn_class(loaded.known(), learnt, options);
        result.name = name;
        result.template_file = Path(files[0]).filename().string();
        make_folder(output);
        std::vector<Path> inputs, outputs;
        for (const auto& file : files) inputs.emplace_back(file);
        for (const char* ending : {".class.json", ".mean.ply", ".mean.npy", ".modes.npy"})
            outputs.push_back(Path(output) / (name + ending));
        check_outputs(inputs, outputs);
        OutputTransaction transaction;
        if (!fs::exists(Path(output) / result.template_file) || !fs::equivalent(Path(output) / result.template_file, files[0]))
            static_cast<void>(copy_template(loaded.file, output, result.template_file, provenance));
        write_class(output, result, provenance);
        WriteOptions how;
        how.comment = provenance.to_line();
        write_mesh(Path(output) / (name + ".mean.ply"), with_points(loaded.mesh, points_of(result.modes.mean)), {}, how);
        transaction.commit();
        print(session, provenance, result);
        return done;
    }

private:
    /// All files are members; the first one says which landmarks there are, and how the mean is turned.
    int run_landmarks(const Session& session) {
        check_names(files);
        if (name.empty()) name = "landmarks";
        check_class_name(name);
        check_folder(output);
        Provenance provenance{"template learn", list_options(options), {}};
        const LandmarkTemplate known = read_landmark_template(files[0], provenance);
        std::vector<LearntMember> members;
        for (const std::string& file : files) {
            members.push_back(read_landmark_member(file, known, provenance));
            for (const std::string& note : members.back().fit.notes)
                session.note(printable(members.back().name) + ": " + printable(note));
        }
        ShapeClass result = learn_class(known.known(), members, options);
        result.name = name;
        result.template_file = Path(files[0]).filename().string();
        make_folder(output);
        std::vector<Path> outputs;
        for (const char* ending : {".class.json", ".mean.mrk.json", ".mean.npy", ".modes.npy"})
            outputs.push_back(Path(output) / (result.name + ending));
        check_outputs({files.begin(), files.end()}, outputs);
        OutputTransaction transaction;
        const Path copy = Path(output) / result.template_file;
        if (!fs::exists(copy) || !fs::equivalent(copy, files[0])) write_file(copy, read_file(files[0]));
        write_class(output, result, provenance);
        write_landmark_mean(outputs[1], known, result.modes.mean, provenance);
        transaction.commit();
        print(session, provenance, result);
        return done;
    }

    static void print(const Session& session, const Provenance& provenance, const ShapeClass& result) {
        const ShapeModes& modes = result.modes;
        if (session.json) {
            Json document(rapidjson::kObjectType);
            auto& allocator = document.GetAllocator();
            JsonValue report(rapidjson::kObjectType), notes(rapidjson::kArrayType), shares(rapidjson::kArrayType);
            add_member(report, "class", result.name, allocator);
            add_member(report, "members", JsonValue(static_cast<std::uint64_t>(result.members.size())), allocator);
            add_member(report, "archetype", result.members[modes.archetype].name, allocator);
            add_member(report, "meanSize", JsonValue(modes.mean_size), allocator);
            add_member(report, "diversity", JsonValue(result.diversity), allocator);
            for (const double variance : modes.variances)
                shares.PushBack(modes.total > 0 ? variance / modes.total : 0, allocator);
            add_member(report, "varianceShares", std::move(shares), allocator);
            for (const std::string& note : result.notes) notes.PushBack(json_string(note, allocator), allocator);
            add_member(report, "notes", std::move(notes), allocator);
            session.print_report(provenance, document, report);
            return;
        }
        std::vector<std::vector<std::string>> rows;
        for (std::size_t i = 0; i < result.members.size(); ++i)
            rows.push_back({printable(result.members[i].name), result.members[i].placed_by, number(result.members[i].scale, 4),
                            number(modes.centroid_sizes[i], 5), number(100 * modes.distances[i], 3),
                            i == modes.archetype ? "archetype" : ""});
        std::cout << table({"member", "laid on by", "scale", "centroid size", "from the mean %", ""}, rows) << '\n';
        rows.clear();
        for (const LearntRange& range : result.ranges) {
            if (range.count == 0) continue;
            const auto bound = [](const std::optional<double>& x) { return x ? number(*x, 4) : std::string("-"); };
            rows.push_back({printable(range.quantity.text()), std::to_string(range.count), number(range.min, 4),
                            number(range.median, 4), number(range.max, 4), number(range.mean, 4),
                            range.deviation ? number(*range.deviation, 3) : "-", bound(range.low), bound(range.high),
                            printable(range.quantity.unit)});
        }
        std::cout << table({"quantity", "n", "min", "median", "max", "mean", "sd", "from", "to", "unit"}, rows);
        double sum = 0;
        rows.clear();
        for (std::size_t k = 0; k < modes.variances.size() && k < 10; ++k) {
            sum += modes.variances[k];
            rows.push_back({std::to_string(k + 1), number(std::sqrt(modes.variances[k]), 4),
                            number(100 * modes.variances[k] / modes.total, 3), number(100 * sum / modes.total, 3)});
        }
        if (!rows.empty()) std::cout << '\n' << table({"mode", "deviation", "% of variance", "together"}, rows);
        for (const std::string& note : result.notes) std::cout << printable(note) << '\n';
        std::cout << result.members.size() << " members of '" << printable(result.name) << "', archetype "
                  << printable(result.members[modes.archetype].name) << '\n';
    }
};

struct Classify {
    std::vector<std::string> files;
    std::string report;
    ClassifyOptions options;

    int run(const Session& session) const {
        check_options(options, "classify");
        Provenance provenance{"template classify", list_options(options), {}};
        std::vector<ShapeClass> classes;
        std::vector<LoadedTemplate> templates;
        std::vector<std::optional<LandmarkTemplate>> landmarks;
        std::vector<std::string> objects, class_files;
        std::vector<std::size_t> same;  // of one name: told apart by their files
        for (const std::string& file : files) {
            if (!file.ends_with(".class.json")) {
                objects.push_back(file);
                continue;
            }
            classes.push_back(read_class(file));
            class_files.push_back(file);
            provenance.add_input(file);
            const std::string& known = classes.back().template_file;
            templates.emplace_back();
            landmarks.emplace_back();
            if (is_landmark_file(known)) landmarks.back() = read_landmark_template(known, provenance);
            else templates.back() = load_class_template(known, provenance);
            check_topology(classes.back(), file, landmarks.back() ? landmarks.back()->mesh : templates.back().mesh, known);
            if (landmarks.front().has_value() != landmarks.back().has_value())
                fail_input(file, "is a class of meshes, or of landmarks, and the first is not", "ask them one after the other");
        }
        for (std::size_t i = 0; i < classes.size(); ++i)
            if (std::count_if(classes.begin(), classes.end(), [&](const auto& c) { return c.name == classes[i].name; }) > 1)
                same.push_back(i);
        for (const std::size_t i : same) classes[i].name += " (" + class_files[i] + ")";
        moderate_thresholds(classes);
        if (classes.empty()) fail_usage("there is no class", "give one or more .class.json files, then objects");
        if (objects.empty()) fail_usage("there is no object", "give mesh files after the classes");
        check_outputs({files.begin(), files.end()}, report.empty() ? std::vector<Path>() : std::vector<Path>{report});
        std::vector<Classification> answers;
        for (const std::string& file : objects) {
            if (landmarks.front()) {
                std::vector<ClassAnswer> list;
                for (std::size_t k = 0; k < classes.size(); ++k)
                    list.push_back(compare_with(classes[k], read_landmark_member(file, *landmarks[k], provenance), options));
                answers.push_back(decide(object_name(file), std::move(list), options));
                continue;
            }
            const WholeObject object = read_member(file, provenance);
            const WholeShape whole = in_file(file, [&] { return measure_whole_shape(object.mesh); });
            std::vector<ClassAnswer> list;
            for (std::size_t k = 0; k < classes.size(); ++k) {
                LearnOptions how;
                how.fit = options.fit;
                how.correspondence = options.correspondence;
                how.modes.sizes = classes[k].sizes;
                list.push_back(compare_with(
                    classes[k], in_file(file, [&] { return learn_member(templates[k].known(), object, how, &whole); }), options));
            }
            answers.push_back(decide(object.name, std::move(list), options));
        }
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        add_member(result, "format", "ostraka-classification", allocator);
        add_member(result, "version", JsonValue(1), allocator);
        for (const Classification& answer : answers) list.PushBack(classification_to_json(answer, allocator), allocator);
        add_member(result, "objects", std::move(list), allocator);
        if (!report.empty()) {
            Json file;
            file.CopyFrom(result, file.GetAllocator());
            add_member(file, "provenance", provenance.to_json(file.GetAllocator()), file.GetAllocator());
            write_json(report, file);
        }
        if (session.json) session.print_report(provenance, document, result);
        else print(answers);
        return std::all_of(answers.begin(), answers.end(), [](const auto& a) { return a.verdict == Membership::member; })
                   ? done
                   : answer_is_no;
    }

private:
    static void print(const std::vector<Classification>& answers) {
        std::vector<std::vector<std::string>> rows;
        for (const Classification& answer : answers)
            for (const ClassAnswer& one : answer.answers)
                rows.push_back({printable(answer.object), printable(one.name), to_string(one.verdict),
                                one.fit.problem.empty() ? number(one.score, 4) : "-", std::to_string(one.against.size())});
        std::cout << table({"object", "class", "verdict", "score", "against"}, rows);
        for (const Classification& answer : answers) {
            std::cout << '\n' << printable(answer.object) << ' ' << printable(answer.text) << '\n';
            for (const ClassAnswer& one : answer.answers) {
                constexpr std::size_t most = 8;
                const auto reasons = one.reasons();
                if (!one.undecided.empty()) std::cout << "  " << printable(one.name) << ": " << printable(one.undecided) << '\n';
                for (std::size_t i = 0; i < reasons.size() && i < most; ++i)
                    std::cout << "  against " << printable(one.name) << ": " << printable(reasons[i]) << '\n';
                if (reasons.size() > most) std::cout << "  and " << reasons.size() - most << " more\n";
            }
        }
    }
};

}  // namespace

void add_template_learn(CLI::App& bundle, Session& session) {
    const auto learn = std::make_shared<Learn>();
    CLI::App* command =
        session.add(bundle, "learn",
                    "learn a class from members of it: ranges of what is measured, mean shape, modes of variation, "
                    "archetype, thresholds",
                    [&session, learn] { return learn->run(session); });
    command
        ->add_option(
            "files", learn->files,
            "the template (.template.json), then a mesh file for each member; NAME.ant.json beside it are its annotations; or "
            "files of landmarks of the same names alone (.mrk.json, .fcsv, .tps, .pp), all of them members")
        ->required()
        ->expected(-1);
    command->add_option("--output", learn->output, "folder for the class and a copy of the template; made if it is missing");
    command->add_option("--name", learn->name, "of the class; else as the template says");
    command->add_flag("--given", learn->given, "the same as --correspondence given");
    add_flags(command, learn->options);

    const auto classify = std::make_shared<Classify>();
    command = session.add(bundle, "classify",
                          "say which class objects belong to, and which proportion, relation or distance speaks against it (exit "
                          "code 3: one belongs to none, or it cannot be told)",
                          [&session, classify] { return classify->run(session); });
    command
        ->add_option("files", classify->files,
                     "classes (.class.json), then a mesh file for each object (of landmarks for classes of landmarks)")
        ->required()
        ->expected(-1);
    command->add_option("--report", classify->report, "write the whole answer as JSON (doc/schema/classification.schema.json)");
    add_flags(command, classify->options);
}

}  // namespace ostraka::app
