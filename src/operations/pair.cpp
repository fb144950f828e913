// pair: registers two fragments along their common fracture.
#include "operations/operations.h"

#include "ostraka/fracture/pair_registration.h"
#include "ostraka/reassembly/suspicious_fragments.h"
#include "ostraka/reconstruction/fragment_file.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct PairFragments final : Operation {
    void declare(Parameters& p) override {
        p.input("first", Kind::mesh, first,
                "mesh file or point cloud of the fragment that stays in place; regions \"outer\", \"inner\" and \"fracture\" in "
                "NAME.ant.json beside NAME.ply override the computed classification of its surface")
            .with_annotations_beside();
        p.input("second", Kind::mesh, second,
                "mesh file or point cloud of the fragment that is moved; a file NAME.ant.json beside it is used in the same way "
                "as for the first fragment")
            .with_annotations_beside();
        p.output("output", Kind::folder, output,
                 "folder, created if missing, for second.ply (the second fragment in the computed pose; face labels 0 outer, 1 "
                 "inner, 2 fracture) and pair.json")
            .flag();
        options.declare_options(p.options);
        reading.declare_options(p.options);
        p.report.schema = "pair";
        p.report.text_table("", {"pose", "score", "contact %", "rim %", "residual", "penetration %"});
    }

    void run(Context& context, Report& report) override {
        // Existing files with these names are replaced or, if written by an earlier run, removed; they must not be inputs.
        if (const Path folder = output.file(); is_folder(folder))
            context.check_outputs({folder / "first.ply", folder / "second.ply", folder / "pair.json"});
        const FragmentFile &a = read(first), &b = read(second);
        const auto prepare = [&](const FileInput& slot, const Fragment& fragment) {
            return in_file(slot.file(), [&] { return PreparedFracture(fragment, options); });
        };
        // Named before the registration, which may fail because of them.
        const std::vector<SuspiciousFragment> suspicious = suspicious_fragments({a.fragment, b.fragment});
        for (const SuspiciousFragment& outlier : suspicious)
            report.note(fmt::format("{} {}", printable((outlier.fragment == 0 ? first : second).file()), outlier.text));
        PairRegistration pair = register_fractures(prepare(first, a.fragment), prepare(second, b.fragment), options);
        for (const SuspiciousFragment& outlier : suspicious) {
            const std::string name = fmt::format("the {} {}", outlier.fragment == 0 ? "first" : "second", outlier.text);
            if (outlier.left_out) pair.undecided = name, pair.confidence = 0;
            else if (!pair.decided()) pair.undecided += "; " + name;
        }
        const JsonValue result = pair_to_json(pair, first.file_name(), second.file_name(), report.allocator());
        report.values(result);
        output.write("pair.json", result);
        if (!pair.candidates.empty()) write("second.ply", b.fragment, pair.candidates.front().pose);
        if (a.points) write("first.ply", a.fragment, Motion());

        for (const auto& [slot, file, fracture] :
             {std::tuple{&first, &a, pair.fracture_a}, std::tuple{&second, &b, pair.fracture_b}})
            report.line(
                fmt::format("{}: facets by {}, fracture {}", printable(slot->file()), file->facets_from, number(fracture, 4)));
        std::size_t count = 0;
        for (const PairCandidate& candidate : pair.candidates) {
            report.row("",
                       {++count, number(candidate.score, 3), number(100 * candidate.contact, 3), number(100 * candidate.rim, 3),
                        number(candidate.residual, 3), number(100 * candidate.penetration, 2)});
        }
        const std::string confidence = "confidence " + number(pair.confidence, 2);
        report.line(pair.decided() ? "they join as in pose 1, " + confidence
                                   : fmt::format("cannot decide, because {} ({})", pair.undecided, confidence));
        if (!pair.decided()) report.answer_no();
    }

    [[nodiscard]] const FragmentFile& read(const FileInput& slot) const {
        const auto& file =
            slot.load<FragmentFile>([&](const Path& path) { return read_fragment(path, reading); }, 0, options_text(reading));
        slot.context->notes(slot.file(), file.notes);
        return file;
    }

    void write(const std::string& name, const Fragment& fragment, const Motion& pose) const {
        MeshExtras extras;
        for (const Facet facet : fragment.facets) extras.face_labels.push_back(static_cast<std::int32_t>(facet));
        output.write(name, moved(fragment.mesh, pose), extras);
    }

    FileInput first, second;
    FolderOutput output;
    PairOptions options;
    FragmentFileOptions reading;
};

}  // namespace

std::unique_ptr<Operation> make_pair() { return make<PairFragments>(); }

}  // namespace ostraka
