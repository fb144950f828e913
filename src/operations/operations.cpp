// operations: the table of operations itself
#include "operations/operations.h"

#include "ostraka/operations/pages.h"

namespace ostraka {

namespace {

struct Operations final : Operation {
    void declare(Parameters& p) override {
        p.options("name", name, "list only operations whose names begin with this text").positional();
        p.output_option("pages", Kind::folder, pages,
                        "folder to write: a page of Markdown for each first word of the operations' names");
        p.output_option("manuals", Kind::folder, manuals, "folder to write: a manual page for each operation");
        p.output_option("completions", Kind::folder, shells, "folder to write: completion scripts for bash, zsh and fish");
        p.report.table("operations", text("name", "operation"), text("help", "description"), any("inputs"), any("outputs"),
                       any("options"), any("arguments"), any("result"));
    }

    void run(Context&, Report& report) override {
        bool any_matching = false;
        for (const OperationEntry& entry : operations()) {
            if (!std::string(entry.name).starts_with(name)) continue;
            any_matching = true;
            Report::Row row = report.row("operations");
            JsonValue declaration = Call(entry).declaration(report.allocator());
            for (auto& member : declaration.GetObject()) {
                const std::string key = member.name.GetString();
                if (member.value.IsString()) row(key, std::string(member.value.GetString()));
                else row(key, std::move(member.value));
            }
        }
        if (!any_matching) static_cast<void>(find_operation(name));
        if (pages)
            for (const std::string& word : command_page_names()) write_text(pages, word + ".md", command_page(word));
        if (manuals)
            for (const OperationEntry& entry : operations()) write_text(manuals, manual_name(entry) + ".1", manual_page(entry));
        if (shells) {
            write_text(shells, "ostraka", completion_script(Shell::bash));
            write_text(shells, "_ostraka", completion_script(Shell::zsh));
            write_text(shells, "ostraka.fish", completion_script(Shell::fish));
        }
    }

    /// Keeps other files in the folder, which may belong to the user.
    static void write_text(const FolderOutput& folder, const std::string& file, const std::string& text) {
        folder.open(0, false);
        write_file(folder.in(file), text);
    }

    std::string name;
    FolderOutput pages, manuals, shells;
};

}  // namespace

std::unique_ptr<Operation> make_operations() { return make<Operations>(); }

}  // namespace ostraka
