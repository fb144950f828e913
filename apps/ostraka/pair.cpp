// ostraka pair: two fragments laid together by the break they share.
#include "command.h"

#include "ostraka/fitting/break_pair.h"
#include "ostraka/fitting/fragment_file.h"
#include "ostraka/io/mesh_file.h"

#include <array>
#include <filesystem>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Pair {
    std::string first, second, output;
    PairOptions options;
    FragmentFileOptions reading;

    int run(const Session& session) const {
        check_options(options, "pair");
        check_options(reading, "pair");
        if (output.empty()) fail_usage("there is no folder to write to", "give --output FOLDER");
        check_folder();
        Provenance provenance{"pair", list_options(options), {}};
        for (auto& option : list_options(reading)) provenance.options.push_back(std::move(option));
        std::array<FragmentFile, 2> files{read_fragment(first, reading), read_fragment(second, reading)};
        for (std::size_t k = 0; k < 2; ++k) {
            for (const Path& input : files[k].inputs) provenance.add_input(input);
            for (const auto& note : files[k].notes) session.note("note: " + printable(k == 0 ? first : second) + ": " + note);
        }
        const BreakPair pair = pair_breaks(files[0].fragment, files[1].fragment, options);
        write(files, pair, provenance);
        Json document(rapidjson::kObjectType);
        if (session.json) {
            JsonValue report = pair_to_json(pair, name(first), name(second), document.GetAllocator());
            session.print_report(provenance, document, report);
        } else {
            print(pair, files);
        }
        return pair.decided() ? done : answer_is_no;
    }

private:
    static std::string name(const std::string& file) { return Path(file).filename().string(); }

    /// What is there under a name that this command uses is replaced or, if an earlier run wrote it, removed: it is no input.
    void check_folder() const {
        std::error_code code;
        const Path folder(output);
        if (!std::filesystem::is_directory(folder, code)) return;
        check_outputs({first, second}, {folder / "first.ply", folder / "second.ply", folder / "pair.json"});
    }

    void write(const std::array<FragmentFile, 2>& files, const BreakPair& pair, const Provenance& provenance) const {
        std::error_code code;
        std::filesystem::create_directories(output, code);
        if (code) throw Error(ErrorKind::failure, output, "the folder cannot be made: " + code.message(), "name another one");
        OutputTransaction transaction;
        replace_outputs(output, "pair");
        Json document(rapidjson::kObjectType);
        JsonValue report = pair_to_json(pair, name(first), name(second), document.GetAllocator());
        add_member(report, "provenance", provenance.to_json(document.GetAllocator()), document.GetAllocator());
        write_json(Path(output) / "pair.json", report);
        WriteOptions how;
        how.comment = provenance.to_line();
        const auto coloured = [&](const std::string& file, const Fragment& fragment, const Motion& pose) {
            MeshExtras extras;
            for (const Facet facet : fragment.facets) extras.face_labels.push_back(static_cast<std::int32_t>(facet));
            write_mesh(Path(output) / file, moved(fragment.mesh, pose), extras, how);
        };
        if (!pair.candidates.empty()) coloured("second.ply", files[1].fragment, pair.candidates.front().pose);
        if (files[0].points) coloured("first.ply", files[0].fragment, Motion());
        transaction.commit();
    }

    void print(const BreakPair& pair, const std::array<FragmentFile, 2>& files) const {
        for (std::size_t k = 0; k < 2; ++k)
            std::cout << printable(k == 0 ? first : second) << ": facets by " << files[k].facets_from << ", fracture "
                      << number(k == 0 ? pair.fracture_a : pair.fracture_b, 4) << '\n';
        std::vector<std::vector<std::string>> rows;
        for (const PairCandidate& one : pair.candidates)
            rows.push_back({std::to_string(rows.size() + 1), number(one.score, 3), number(100 * one.contact, 3),
                            number(100 * one.rim, 3), number(one.residual, 3), number(100 * one.penetration, 2)});
        if (!rows.empty()) std::cout << table({"pose", "score", "contact %", "rim %", "residual", "penetration %"}, rows);
        if (pair.decided()) std::cout << "they go together as in pose 1, confidence " << number(pair.confidence, 2) << '\n';
        else std::cout << "cannot decide, because " << pair.undecided << " (confidence " << number(pair.confidence, 2) << ")\n";
    }
};

}  // namespace

void add_pair(CLI::App& tool, Session& session) {
    const auto work = std::make_shared<Pair>();
    CLI::App* command =
        session.add(tool, "pair", "lay two fragments together by the break they share; exit code 3 if it cannot be told how",
                    [&session, work] { return work->run(session); });
    command->add_option("first", work->first, "mesh file, or points without faces; it stays where it is")->required();
    command->add_option("second", work->second, "the fragment that is moved")->required();
    command->add_option("--output", work->output,
                        "folder for second.ply (the second fragment where it belongs; face labels 0 outer, 1 inner, 2 "
                        "fracture) and pair.json; made if it is missing");
    add_flags(command, work->options);
    add_flags(command, work->reading);
}

}  // namespace ostraka::app
