#include "command.h"

#include "ostraka/core/error.h"
#include "ostraka/core/file.h"
#include "ostraka/core/text.h"

#include <cctype>
#include <cstdio>
#include <iostream>

namespace ostraka::app {

CLI::App* Session::add(CLI::App& parent, const std::string& name, const std::string& help, std::function<int()> run) {
    CLI::App* command = parent.add_subcommand(name, help);
    command->add_flag("--json", json, "print a report for machines instead of a table");
    command->add_flag("--quiet", quiet, "no notes and no progress bar");
    command->add_option("--threads", threads, "number of threads, 0 for all cores; results do not depend on it")
        ->check(CLI::Range(0, 1024));
    command->callback([this, run = std::move(run)] {
        action = [run] {
            OutputTransaction outputs;
            const int code = run();
            // Where the report could not be given, nothing is replaced.
            check_standard_output();
            outputs.commit();
            return code;
        };
    });
    return command;
}

void Session::note(const std::string& text) const {
    if (!quiet) std::cerr << printable(text) << '\n';
}

void check_standard_output() {
    std::cout.flush();
    if (!std::cout) throw Error(ErrorKind::failure, "standard output", "cannot be written", "free some space or mend the pipe");
}

std::string printable(const std::string& text, std::size_t most) {
    std::string clean;
    std::size_t columns = 0;
    for (std::size_t at = 0; at < text.size();) {
        const Character here = character_at(text, at);
        if (++columns > most) return clean + "...";
        // A byte that begins no character may steer a terminal that does not read UTF-8.
        const bool odd = is_control(here.code) || (here.code == 0xFFFD && here.length == 1);
        clean += odd ? "?" : text.substr(at, here.length);
        at += here.length;
    }
    return clean;
}

void Session::print_report(const Provenance& provenance, Json& document, JsonValue& result, JsonValue* run) const {
    auto& allocator = document.GetAllocator();
    JsonValue report(rapidjson::kObjectType);
    add_member(report, "format", "ostraka-report", allocator);
    add_member(report, "command", provenance.command, allocator);
    add_member(report, "result", std::move(result), allocator);
    add_member(report, "provenance", provenance.to_json(allocator), allocator);
    if (run != nullptr) add_member(report, "run", std::move(*run), allocator);
    std::cout << to_text(report);
}

namespace {
/// Columns on a terminal, not bytes: continuation bytes of UTF-8 take no room.
std::size_t width(const std::string& text) {
    std::size_t count = 0;
    for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    return count;
}
bool is_number(const std::string& text) {
    return !text.empty() && (std::isdigit(static_cast<unsigned char>(text.front())) != 0 || text.front() == '-') &&
           text.find_first_of("0123456789") != std::string::npos;
}
}  // namespace

std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& raw_rows) {
    std::vector<std::vector<std::string>> rows = raw_rows;
    for (auto& row : rows)
        for (auto& cell : row) cell = printable(cell, std::string::npos);
    // Nothing is cut; a cell that is wider than this pushes the rest of its own row aside only.
    constexpr std::size_t widest = 100;
    std::vector<std::size_t> widths(header.size());
    for (std::size_t c = 0; c < header.size(); ++c) {
        widths[c] = width(header[c]);
        for (const auto& row : rows) widths[c] = std::max(widths[c], c < row.size() ? std::min(width(row[c]), widest) : 0);
    }
    std::string text;
    const auto line = [&](const std::vector<std::string>& cells, bool is_header) {
        std::string out;
        for (std::size_t c = 0; c < header.size(); ++c) {
            const std::string cell = c < cells.size() ? cells[c] : "";
            const std::string gap(widths[c] - std::min(widths[c], width(cell)), ' ');
            bool right = is_number(cell);
            if (is_header) {
                right = !rows.empty();
                for (const auto& row : rows)
                    right = right && (c >= row.size() || row[c].empty() || row[c] == "-" || is_number(row[c]));
            }
            out += right ? gap + cell : cell + gap;
            if (c + 1 < header.size()) out += "  ";
        }
        out.erase(out.find_last_not_of(' ') + 1);
        text += out + "\n";
    };
    line(header, true);
    for (const auto& row : rows) line(row, false);
    return text;
}

std::string number(double value, int digits) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
    return buffer;
}

std::size_t add_findings(JsonValue& result, const std::vector<Finding>& findings, const std::string& place,
                         std::vector<std::vector<std::string>>& rows, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    std::size_t defects = 0;
    for (const Finding& finding : findings) {
        defects += finding.defect ? 1 : 0;
        const std::string kind = finding.defect ? "defect" : "remark";
        JsonValue entry(rapidjson::kObjectType);
        add_member(entry, "kind", kind, allocator);
        add_member(entry, place, finding.where, allocator);
        add_member(entry, "text", finding.text, allocator);
        list.PushBack(entry, allocator);
        rows.push_back({kind, finding.where, finding.text});
    }
    add_member(result, "sound", JsonValue(defects == 0), allocator);
    add_member(result, "defects", JsonValue(static_cast<std::uint64_t>(defects)), allocator);
    add_member(result, "findings", std::move(list), allocator);
    return defects;
}

void print_findings(const std::string& place, const std::vector<std::vector<std::string>>& rows, std::size_t defects) {
    if (!rows.empty()) std::cout << table({"kind", place, "what"}, rows);
    std::cout << (defects == 0 ? "no defects" : std::to_string(defects) + (defects == 1 ? " defect" : " defects")) << '\n';
}

int report_findings(const Session& session, const Provenance& provenance, const std::vector<Finding>& findings) {
    Json document(rapidjson::kObjectType);
    JsonValue result(rapidjson::kObjectType);
    std::vector<std::vector<std::string>> rows;
    const std::size_t defects = add_findings(result, findings, "where", rows, document.GetAllocator());
    if (session.json) session.print_report(provenance, document, result);
    else print_findings("where", rows, defects);
    return defects == 0 ? done : answer_is_no;
}

}  // namespace ostraka::app
