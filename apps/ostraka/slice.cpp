// ostraka slice
#include "slice_report.h"

#include "annotation_names.h"
#include "commands.h"
#include "number_lists.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/limits.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/text.h"
#include "ostraka/report/slice_drawing.h"
#include "ostraka/report/table.h"
#include "ostraka/slicing/curve_slices.h"
#include "ostraka/slicing/silhouette.h"

#include <cmath>
#include <iostream>
#include <memory>
#include <numeric>

namespace ostraka::app {

namespace {

struct SliceCommand {
    std::string mesh, annotations, direction = "up", up, heights, range = "0,1", plane, unit, colour_by = "height", medial, angle,
                                   profile, title;
    std::vector<std::string> names, outputs;
    int count = 0, drawn = 24;
    double spacing = 0;
    bool axes = false;
    TubeOptions tube_options;
    AxisOptions axis_options;
    ReadAnnotationsOptions reading;

    // Set by `run`.
    MeshFile file;
    std::vector<Index> faces;  ///< of the part; empty: all
    std::array<double, 3> upward{0, 0, 1};
    bool up_known = false;
    CutObject cut;
    std::vector<Point> curve;  ///< what was cut across, if not parallel
    double lowest = 0, highest = 0;
    std::pair<double, double> over_plane{0, 0};  ///< heights of the mesh over --plane

    int run(const Session& session) {
        check_words();
        std::vector<Path> inputs{mesh};
        if (!annotations.empty()) inputs.emplace_back(annotations);
        const auto files = output_files();
        std::vector<Path> plain;
        for (const auto& [kind, path] : files)
            if (std::find(outputs.begin(), outputs.end(), path.string()) != outputs.end() || path == profile)
                plain.push_back(path);
        check_outputs(inputs, plain);
        Provenance provenance{"slice", list_options(tube_options), {}};
        for (const auto& [key, value] : words()) provenance.options.emplace_back(key, value);
        for (const auto& name : names) provenance.options.emplace_back("annotation", name);
        for (const Path& input : inputs) provenance.add_input(input);
        file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        read_part();
        std::string none;
        in_file(mesh, [&] { none = cut_mesh(); });
        if (!none.empty()) {
            std::cerr << "ostraka: " << printable(mesh + ": " + none) << '\n';
            return answer_is_no;
        }
        const auto found = find_axes();
        const SliceStack stack = cut.stack();
        const Tube tube = plane.empty() ? tubular_part(stack, cut.descriptors, tube_options) : Tube{};
        const ThicknessHomogeneity thickness = thickness_homogeneity(cut.slices);

        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        if (!unit.empty()) add_member(result, "unit", unit, allocator);
        add_member(result, "planes", cut.parallel ? "parallel" : "across a curve", allocator);
        add_member(result, "reversed", JsonValue(cut.reversed), allocator);
        if (cut.parallel && plane.empty()) {
            JsonValue list(rapidjson::kArrayType);
            list.PushBack(lowest, allocator).PushBack(highest, allocator);
            add_member(result, "heights_of_the_mesh", std::move(list), allocator);
        }
        add_member(result, "slices", json_of(cut, allocator), allocator);
        add_member(result, "axes", json_of(found, allocator), allocator);
        add_member(result, "thickness", json_of(thickness, allocator), allocator);
        if (plane.empty()) add_member(result, "tube", json_of(tube, cut, allocator), allocator);
        write(files, result, provenance, session);
        if (session.json) session.print_report(provenance, document, result);
        else print(found, tube, thickness);
        if (!up_known && (direction == "rotation" || direction == "principal"))
            session.note("note: which end of the axis is up is not known (0,0,1 taken): if it is upside down, give --up");
        if (!cut.parallel && is_hollow())
            session.note(
                "note: the object is hollow: its skeleton lies in the wall or wanders through the mouth, so that slices across "
                "it "
                "cut the wall aslant (--direction rotation or up cuts a vessel)");
        for (const auto& note : remarks_of(cut, plane.empty() ? std::pair(0.0, highest) : over_plane, !plane.empty()))
            session.note("note: " + note);
        const bool met = std::any_of(cut.slices.begin(), cut.slices.end(), [](const Slice& s) { return !s.contours.empty(); });
        return met ? done : answer_is_no;
    }

private:
    enum class Kind { json, csv, sheet, profile, ply };

    void check_words() const {
        const int ways = (count > 0) + (spacing > 0) + !heights.empty();
        if (ways > 1) fail_usage("heights are asked for in more than one way", "give one of --count, --spacing and --heights");
        if (!plane.empty() && (ways > 0 || direction != "up"))
            fail_usage("--plane is one slice", "leave out --count, --spacing, --heights, --direction");
        if (direction == "skeleton" && (spacing > 0 || !heights.empty()))
            fail_usage("--spacing and --heights with --direction skeleton", "give --count");
        if (annotations.empty() && !names.empty())
            fail_usage("--annotation '" + printable(names[0], 60) + "' names a part of " + printable(mesh, 60) +
                           ", but no annotation file is given",
                       "put it behind the mesh: ostraka slice MESH ANNOTATIONS --annotation ...");
        if (!angle.empty()) static_cast<void>(turn_of_profile());
        for (const double residue : medial.empty() ? std::vector<double>{} : numbers_of<double>(medial, "--medial-axis"))
            if (!(residue >= 0.001 && residue <= 1))
                fail_usage("--medial-axis has a residue of " + number(residue), "use 0.001 to 1");
        for (const double height : heights.empty() ? std::vector<double>{} : numbers_of<double>(heights, "--heights"))
            if (!(std::abs(height) <= largest_coordinate))
                fail_usage("--heights has " + number(height), "give heights over the lowest place, in the mesh's unit");
        if (direction == "skeleton" && !profile.empty())
            fail_usage("--profile with --direction skeleton", "a profile has a straight axis");
        if (!plane.empty() && !profile.empty())
            fail_usage("--profile with --plane", "a profile is cut along an axis: --direction, --profile-angle");
    }

    /// In radians.
    [[nodiscard]] double turn_of_profile() const {
        const auto degrees = numbers_of<double>(angle, "--profile-angle");
        if (degrees.size() != 1 || !(std::abs(degrees[0]) <= 360))
            fail_usage("--profile-angle is '" + printable(angle, 60) + "'", "give one angle from -360 to 360 degrees");
        return degrees[0] * M_PI / 180;
    }

    [[nodiscard]] std::vector<std::pair<std::string, std::string>> words() const {
        std::vector<std::pair<std::string, std::string>> list{
            {"direction", direction}, {"range", range}, {"colour-by", colour_by}};
        for (const auto& [key, value] : {std::pair{"up", up},
                                         {"heights", heights},
                                         {"plane", plane},
                                         {"unit", unit},
                                         {"medial-axis", medial},
                                         {"profile-angle", angle},
                                         {"title", title}})
            if (!value.empty()) list.emplace_back(key, value);
        if (count > 0) list.emplace_back("count", std::to_string(count));
        if (spacing > 0) list.emplace_back("spacing", number(spacing, 17));
        if (axes) list.emplace_back("axes", "true");
        return list;
    }

    /// Whether the name is that of a folder, there or not.
    static bool is_folder(const std::string& name, const std::string& ending) {
        std::error_code code;
        if (std::filesystem::is_directory(name, code)) return true;
        if (ending.empty() && std::filesystem::exists(name, code))
            fail_usage("output '" + printable(name, 60) + "' is no folder",
                       "give a folder, or a name that ends in .json, .csv, .svg, .png or .ply");
        return ending.empty();
    }

    static void make_folder(const Path& folder) {
        std::error_code code;
        std::filesystem::create_directories(folder, code);
        if (code || !std::filesystem::is_directory(folder, code))
            throw Error(ErrorKind::failure, folder.string(), "cannot be made" + (code ? ": " + code.message() : ""),
                        "check that the folder it is to be in may be written to");
    }

    /// A name without a known ending is a folder that gets everything.
    [[nodiscard]] std::vector<std::pair<Kind, Path>> output_files() const {
        std::vector<std::pair<Kind, Path>> files;
        for (const auto& name : outputs) {
            const std::string ending = extension(name);
            if (ending == ".json") files.emplace_back(Kind::json, name);
            else if (ending == ".csv") files.emplace_back(Kind::csv, name);
            else if (ending == ".svg" || ending == ".png") files.emplace_back(Kind::sheet, name);
            else if (ending == ".ply") files.emplace_back(Kind::ply, name);
            else if (is_folder(name, ending)) {
                const Path folder(name);
                files.emplace_back(Kind::json, folder / "slices.json");
                files.emplace_back(Kind::csv, folder / "slices.csv");
                files.emplace_back(Kind::sheet, folder / "slices.svg");
                files.emplace_back(Kind::ply, folder / "slices.ply");
                if (plane.empty() && direction != "skeleton") files.emplace_back(Kind::profile, folder / "profile.svg");
            } else
                fail_usage("'" + name + "' is none of the files that slices are written to",
                           "end its name in .json, .csv, .svg, .png or .ply, or give a folder for all of them");
        }
        if (!profile.empty()) {
            if (extension(profile) != ".svg" && extension(profile) != ".png")
                fail_usage("'" + profile + "' is no drawing", "end its name in .svg or .png");
            files.emplace_back(Kind::profile, profile);
        }
        return files;
    }

    void read_part() {
        up_known = !up.empty();
        if (!up.empty()) upward = direction_of(up, "--up");
        if (annotations.empty()) return;
        const AnnotationSet set = read_annotations(annotations, file.mesh, reading);
        if (unit.empty()) unit = set.unit;
        if (up.empty() && set.up) upward = *set.up, up_known = true;
        for (const auto& name : names) {
            const Annotation& annotation = find_annotation(set, name, annotations);
            if (annotation.type != AnnotationType::region)
                fail_usage("annotation '" + name + "' is no region", "only regions can be sliced");
            faces.insert(faces.end(), annotation.faces.begin(), annotation.faces.end());
        }
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    }

    [[nodiscard]] std::vector<Index> all_faces() const {
        if (!faces.empty()) return faces;
        std::vector<Index> all(file.mesh.number_of_faces());
        std::iota(all.begin(), all.end(), Index{0});
        return all;
    }

    [[nodiscard]] Axis axis_by(const std::string& method) const {
        AxisOptions options = axis_options;
        options.method = method;
        return find_axis(file.mesh, all_faces(), options);
    }

    /// The axis to slice along; an error says so in the words of this command.
    [[nodiscard]] Axis axis_of_direction() const {
        try {
            return axis_by(direction);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
            fail_input(mesh, "no " + direction + " axis to slice along: the mesh (or part) " + error.problem(),
                       "repair or simplify it (ostraka mesh), or slice along another --direction, such as up or 0,0,1");
        }
    }

    [[nodiscard]] SliceFrame asked_plane() const {
        const auto numbers = numbers_of<double>(plane, "--plane");
        const std::string what = "--plane is '" + printable(plane, 60) + "'";
        if (numbers.size() != 6) fail_usage(what, "give six numbers: a point and the normal");
        if (!is_place(numbers[0], numbers[1], numbers[2]))
            fail_usage(what + ": its point is no place", "give finite coordinates, within those of the mesh");
        const Vector normal(numbers[3], numbers[4], numbers[5]);
        if (unit_vector(normal) == CGAL::NULL_VECTOR)
            fail_usage(what + ": its normal has no direction", "give finite numbers that are not all 0");
        return slice_frame({numbers[0], numbers[1], numbers[2]}, normal);
    }

    /// Fills `cut`; or says why there is nothing to cut by.
    std::string cut_mesh() {
        const auto all = all_faces();
        if (std::none_of(all.begin(), all.end(), [&](Index f) { return face_area(file.mesh, Face(f)) > 0; }))
            fail_input(mesh, "nothing to slice: all its " + std::to_string(all.size()) + " triangles are lines or points",
                       "use a mesh with a surface");
        if (!plane.empty()) {
            const SliceFrame frame = asked_plane();
            over_plane = height_range(file.mesh, frame, faces);
            set_parallel(frame, {0});
            return {};
        }
        Vector along(upward[0], upward[1], upward[2]);
        const auto box = bounding_box(file.mesh);
        Point through((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
        if (direction == "principal" || direction == "rotation" || direction == "skeleton") {
            const Axis axis = axis_of_direction();
            if (!axis.found)
                return "no " + direction + " axis to slice along: " + axis.reason + " (slice along another --direction)";
            if (direction == "skeleton") {
                curve = axis.lines.at(0);
                set_along();
                return {};
            }
            // Upwards as far as the axis says anything of it.
            along = axis.direction * along < 0 ? -axis.direction : axis.direction;
            through = axis.point;
        } else if (direction != "up") {
            if (direction.find_first_of("0123456789,") == std::string::npos &&
                direction.find_first_of("xyz") != direction.size() - 1)
                fail_usage("--direction is '" + printable(direction, 60) + "'",
                           "use up, principal, rotation, skeleton, an axis (x, y, z, -x, -y, -z) or three numbers like 0,1,0");
            const auto numbers = direction_of(direction, "--direction");
            along = {numbers[0], numbers[1], numbers[2]};
        }
        SliceFrame frame = slice_frame(through, along);
        const auto ends = height_range(file.mesh, frame, faces);
        frame.origin = through + ends.first * frame.normal;
        highest = ends.second - ends.first;
        set_parallel(frame, asked_heights());
        return {};
    }

    [[nodiscard]] std::vector<double> asked_heights() const {
        if (!heights.empty()) return numbers_of<double>(heights, "--heights");
        const auto share = numbers_of<double>(range, "--range");
        if (share.size() != 2 || !(share[0] >= 0 && share[0] < share[1] && share[1] <= 1))
            fail_usage("--range is '" + printable(range, 60) + "'",
                       "give two shares of the height, the lower one first, like 0,0.4");
        const double from = share[0] * highest, to = share[1] * highest;
        return spacing > 0 ? slice_heights_spaced(from, to, spacing) : slice_heights(from, to, count > 0 ? count : 50);
    }

    void set_parallel(const SliceFrame& frame, const std::vector<double>& places) {
        SliceStack stack = slice_mesh(file.mesh, frame, places, faces);
        cut.frames.assign(places.size(), frame);
        cut.slices = std::move(stack.slices);
        cut.reversed = stack.reversed;
        describe();
    }

    void set_along() {
        CurveSlices slices = slice_along(file.mesh, curve, count > 0 ? count : 50, faces);
        cut.parallel = false;
        cut.frames = std::move(slices.frames);
        cut.slices = std::move(slices.slices);
        cut.reversed = slices.reversed;
        highest = slices.length;
        describe();
    }

    void describe() {
        cut.descriptors = describe_slices(cut.slices);
        if (medial.empty()) return;
        auto residues = numbers_of<double>(medial, "--medial-axis");
        std::sort(residues.begin(), residues.end());
        cut.medial.resize(cut.slices.size());
        parallel_for(
            cut.slices.size(), [&](std::size_t i) { cut.medial[i] = medial_axis(cut.slices[i], residues); }, 1);
    }

    /// Whether a quarter of 24 level slices are half empty within, by area.
    [[nodiscard]] bool is_hollow() const {
        const SliceFrame frame = slice_frame(Point(0, 0, 0), Vector(upward[0], upward[1], upward[2]));
        const auto ends = height_range(file.mesh, frame, faces);
        const auto level =
            describe_slices(slice_mesh(file.mesh, frame, slice_heights(ends.first, ends.second, 24), faces).slices);
        return 4 * std::count_if(level.begin(), level.end(), [](const auto& d) { return d.hole_area_ratio > 0.5; }) >= 24;
    }

    [[nodiscard]] std::vector<NamedAxis> find_axes() const {
        std::vector<NamedAxis> list;
        const auto centres = cut.centres();
        if (centres.size() < 2) return list;
        const auto add_line = [&](const std::string& name, const SliceLine& line) {
            list.push_back({name, "", line, {}, straightness(centres, line)});
        };
        if (cut.parallel) add_line("mean of barycentres", mean_line(cut.frames[0], centres));
        if (centres.size() == 2) list.push_back({"regression of barycentres", "two places are always in line", {}, {}, {}});
        else try {
                add_line("regression of barycentres", regression_line(cut.frames[0], centres));
            } catch (const Error& error) {
                list.push_back({"regression of barycentres", error.problem(), {}, {}, {}});
            }
        if (!curve.empty()) list.push_back({"skeleton", "", {}, curve, straightness(centres, curve)});
        if (!axes) return list;
        for (const std::string method : {"rotation", "principal", "slices", "skeleton"}) {
            if (method == "skeleton" && !curve.empty()) continue;
            try {
                const Axis axis = axis_by(method);
                if (!axis.found) list.push_back({method, axis.reason, {}, {}, {}});
                else if (method == "rotation" || method == "principal") add_line(method, {axis.point, axis.direction});
                else list.push_back({method, "", {}, axis.lines.at(0), straightness(centres, axis.lines.at(0))});
            } catch (const Error& error) {
                list.push_back({method, error.problem(), {}, {}, {}});
            }
        }
        return list;
    }

    [[nodiscard]] std::string name_of_drawing() const { return title.empty() ? Path(mesh).filename().string() : title; }

    /// The slices drawn: all, or as many as asked for, spread evenly.
    [[nodiscard]] SliceSheet sheet() const {
        SliceSheet content;
        content.title =
            name_of_drawing() + ": " + std::to_string(cut.slices.size()) + (cut.slices.size() == 1 ? " slice" : " slices");
        content.unit = unit;
        const std::size_t n = cut.slices.size(), most = static_cast<std::size_t>(drawn);
        for (std::size_t k = 0; k < std::min(n, most); ++k) {
            const std::size_t i = n <= most ? k : k * (n - 1) / std::max<std::size_t>(1, most - 1);
            DrawnSlice entry{&cut.slices[i], &cut.descriptors[i], {}, i + 1};
            if (!cut.medial.empty() && !cut.medial[i].levels.empty())
                for (const auto& branch : cut.medial[i].levels[0].branches) entry.lines.push_back(branch.points);
            content.slices.push_back(entry);
        }
        if (n > most) content.title += ", " + std::to_string(most) + " of them drawn";
        if (cut.parallel && plane.empty()) {
            SliceFrame view = cut.frames[0];
            view.v = view.normal;
            view.normal = CGAL::cross_product(view.u, view.v);
            content.view = silhouette(file.mesh, view, 500, faces);
        }
        return content;
    }

    /// The axis of the profile: through the medians of the barycentres, which an arm or a handle does not move.
    [[nodiscard]] SliceFrame profile_axis() const {
        SliceFrame frame = cut.frames[0];
        if (direction == "rotation") return frame;
        std::vector<double> x, y;
        for (const auto& d : cut.descriptors)
            if (d.outline_barycentre.allFinite()) x.push_back(d.outline_barycentre.x()), y.push_back(d.outline_barycentre.y());
        if (x.empty()) return frame;
        const auto middle = [](std::vector<double>& values) {
            std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
            return values[values.size() / 2];
        };
        const double mx = middle(x), my = middle(y);
        frame.origin = frame.point({mx, my}, 0);
        return frame;
    }

    void write(const std::vector<std::pair<Kind, Path>>& files, const JsonValue& result, const Provenance& provenance,
               const Session& session) const {
        OutputTransaction together;
        for (const auto& [kind, path] : files) {
            if (path.has_parent_path()) make_folder(path.parent_path());
            if (kind == Kind::json) {
                Json document(rapidjson::kObjectType);
                auto& allocator = document.GetAllocator();
                add_member(document, "format", "ostraka-slices", allocator);
                add_member(document, "version", JsonValue(1), allocator);
                for (auto member = result.MemberBegin(); member != result.MemberEnd(); ++member)
                    add_member(document, member->name.GetString(), JsonValue(member->value, allocator), allocator);
                add_member(document, "provenance", provenance.to_json(allocator), allocator);
                write_json(path, document);
            } else if (kind == Kind::csv) {
                write_file(path, csv_of(cut, unit));
            } else if (kind == Kind::ply) {
                MeshExtras extras;
                extras.face_colours = slice_colours(file.mesh, cut, colour_by);
                WriteOptions options;
                options.comment = provenance.to_line();
                for (const auto& note : write_mesh(path, file.mesh, extras, options)) session.note("note: " + note);
            } else if (kind == Kind::sheet) {
                if (drawable(path, session)) write_slice_sheet(path, sheet());
            } else if (drawable(path, session)) {
                draw_profile(path, session);
            }
        }
        for (const auto& name : outputs)
            if (std::filesystem::is_directory(name)) replace_outputs(name, "slice");
        together.commit();
    }

    /// Of what was not turned only where it was asked for.
    void draw_profile(const Path& path, const Session& session) const {
        const double turn = angle.empty() ? std::numeric_limits<double>::quiet_NaN() : turn_of_profile();
        const Profile drawn_one = find_profile(file.mesh, profile_axis(), turn);
        const std::string not_turned = "note: not a turned object about this axis (fewer than half of 24 slices are round): ";
        if (!drawn_one.turned && path != profile) {
            session.note(not_turned + path.filename().string() + " is not written; --profile FILE draws it all the same");
            return;
        }
        if (!drawn_one.turned) session.note(not_turned + "a profile drawing says little of it");
        if (drawn_one.hides)
            session.note("note: " + path.filename().string() +
                         " does not show all that stands out from the turned body: some of it lies before or behind it");
        write_profile_drawing(path, drawn_one, name_of_drawing(), unit);
    }

    /// Nothing is drawn where nothing was met.
    bool drawable(const Path& path, const Session& session) const {
        for (const auto& slice : cut.slices)
            if (!slice.contours.empty()) return true;
        session.note("note: no plane meets the mesh: " + path.filename().string() + " is not written");
        return false;
    }

    void print(const std::vector<NamedAxis>& found, const Tube& tube, const ThicknessHomogeneity& thickness) const {
        std::vector<std::vector<std::string>> rows;
        const auto cell = [](double value, int digits = 4) {
            return std::isfinite(value) ? number(value, digits) : std::string("-");
        };
        for (std::size_t i = 0; i < cut.slices.size(); ++i) {
            const auto& d = cut.descriptors[i];
            rows.push_back({std::to_string(i + 1), number(cut.slices[i].height), std::to_string(cut.slices[i].contours.size()),
                            cell(d.area), cell(d.perimeter), cell(d.eccentricity, 3), cell(d.solidity, 3), cell(d.compactness, 3),
                            cell(100 * d.roundness_fitted_relative, 3), cell(d.hole_area_ratio, 3), cell(d.thickness_mean, 3),
                            cut.slices[i].contours.empty() ? "empty" : number(100 * cut.slices[i].completeness.share, 3)});
        }
        std::cout << table({"slice", cut.parallel ? "height" : "along the curve", "contours", "area", "perimeter", "m/M",
                            "solidity", "compactness", "off circle %", "hole ratio", "thickness", "complete %"},
                           rows);
        std::cout
            << "m/M: sides of the smallest rectangle around the whole slice, loose pieces too (`eccentricity` in files; 1 for a "
               "circle); off circle: mean distance from the best circle, of its radius\n";
        rows.clear();
        for (const auto& axis : found) {
            const auto& s = axis.straightness;
            if (axis.reason.empty())
                rows.push_back({axis.name, number(s.mean), number(s.most), number(s.length), number(100 * s.relative, 3)});
            else rows.push_back({axis.name, "-", "-", "-", axis.reason});
        }
        if (!rows.empty()) std::cout << '\n' << table({"axis", "mean distance", "largest", "length", "mean / length %"}, rows);
        if (std::isfinite(thickness.mean))
            std::cout << "\nwall " << number(thickness.mean) << (unit.empty() ? "" : " " + unit) << ": varies by "
                      << cell(100 * thickness.within, 3) << " % within slices, "
                      << (thickness.slices < 2 ? std::string("and one slice tells nothing of how it does between them")
                                               : cell(100 * thickness.across, 3) + " % between them")
                      << " (medians; " << thickness.slices << " of " << cut.slices.size() << " slices show the wall alone)\n";
        else if (thickness.beside > 0)
            std::cout << "\nno slice shows the wall alone: all that do have handles or other parts beside it\n";
        if (!plane.empty()) return;
        if (tube.found) {
            std::vector<double> sorted;
            for (const auto& slice : cut.slices) sorted.push_back(slice.height);
            std::sort(sorted.begin(), sorted.end());
            std::cout << "\ntubular from " << number(sorted[tube.first]) << " to " << number(sorted[tube.last])
                      << (unit.empty() ? "" : " " + unit) << " (" << tube.last - tube.first + 1 << " slices)\n";
        } else {
            std::cout << "\nno tubular part: " << tube.reason << '\n';
        }
    }
};

}  // namespace

void add_slice(CLI::App& tool, Session& session) {
    const auto slice = std::make_shared<SliceCommand>();
    CLI::App* command =
        session.add(tool, "slice", "cut an object into slices, describe and draw them; exit code 3 if no plane meets it",
                    [&session, slice] { return slice->run(session); });
    const auto given = [](const std::string& text) { return text.empty() ? std::string("is empty: leave it out") : ""; };
    command->add_option("mesh", slice->mesh, "mesh file")->required();
    command->add_option("annotations", slice->annotations, "its annotations (.ant.json): unit, upward direction, parts");
    command->add_option("--annotation", slice->names, "id or tag of a region: slice that part only; more than one: all together");
    command
        ->add_option("--direction", slice->direction,
                     "across what: up, principal, rotation, skeleton, an axis such as y or -z, or three numbers like 0,1,0")
        ->capture_default_str();
    command->add_option("--up", slice->up,
                        "x, y, z, -x, -y, -z or three numbers: upward direction; else as the annotations say, else 0,0,1");
    command->add_option("--count", slice->count, "number of slices, in the middles of as many layers (default 50)")
        ->check(CLI::Range(1, 1000000));
    command->add_option("--spacing", slice->spacing, "distance of the slices, in the mesh's unit, from the lowest place up")
        ->check([](const std::string& text) {
            const auto value = number_of(text);
            const bool sound = value && *value > 0 && *value <= largest_coordinate;
            return sound ? std::string() : "'" + printable(text, 60) + "' is no length above 0";
        });
    command->add_option("--heights", slice->heights, "heights over the lowest place, with commas between them");
    command->add_option("--range", slice->range, "shares of the height between which to cut, for --count and --spacing")
        ->capture_default_str();
    command->add_option("--plane", slice->plane, "one slice: a point and the normal, x,y,z,nx,ny,nz");
    command
        ->add_option("--output", slice->outputs,
                     "a folder for everything, or .json (all), .csv (descriptors), .svg, .png (drawing), .ply (slices on the "
                     "mesh); repeatable")
        ->check(given);
    command->add_option("--profile", slice->profile, "write a profile drawing (.svg, .png)")->check(given);
    command->add_option("--title", slice->title, "title of the drawings; else the mesh file's name");
    command->add_option("--profile-angle", slice->angle, "direction of the section of the profile, degrees; else a typical one");
    command->add_option("--drawn", slice->drawn, "most slices on the drawing")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    command->add_option("--colour-by", slice->colour_by, "what colours the .ply: height, or a descriptor as the CSV names them")
        ->capture_default_str();
    command->add_option("--medial-axis", slice->medial, "medial axes of the slices at these residues, like 0.01,0.05,0.15");
    command->add_flag("--axes", slice->axes, "straightness against the axes of `ostraka axis` as well");
    command->add_option("--unit", slice->unit, "unit of the mesh; else as the annotations say");
    add_flags(command, slice->tube_options);
    add_flags(command, slice->reading);
}

}  // namespace ostraka::app
