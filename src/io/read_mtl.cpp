#include "io/materials.h"
#include "io/text_reader.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::io {

namespace {

constexpr std::size_t max_library_bytes = std::size_t{64} << 20;
constexpr std::size_t max_libraries = 100, max_materials = 100000, max_missing_images = 64;

bool is_blank_character(char c) { return TextReader::is_blank(c); }

std::string_view without_blanks(std::string_view text) {
    while (!text.empty() && is_blank_character(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank_character(text.back())) text.remove_suffix(1);
    return text;
}

/// Takes the first word off a text.
std::string_view take_word(std::string_view& text) {
    text = without_blanks(text);
    std::size_t length = 0;
    while (length < text.size() && !is_blank_character(text[length])) ++length;
    const std::string_view word = text.substr(0, length);
    text = without_blanks(text.substr(length));
    return word;
}

/// Numbers at the beginning of a text, at most `max_count`, which are taken off it.
std::vector<double> take_numbers(std::string_view& text, std::size_t max_count) {
    std::vector<double> numbers;
    while (numbers.size() < max_count) {
        std::string_view rest = text;
        const auto number = number_of(take_word(rest));
        if (!number) break;
        numbers.push_back(*number);
        text = rest;
    }
    return numbers;
}

bool is_map_keyword(std::string_view keyword) {
    const std::string word = lower_case(keyword);
    return word.starts_with("map_") || word == "bump" || word == "disp" || word == "decal" || word == "refl" || word == "norm";
}

/// Takes the options of a map statement off the text behind its keyword; what remains is the reference to the image.
void take_options(std::string_view& text, MapStatement& statement) {
    // Numbers of values; options with one word have -1.
    static const std::map<std::string_view, int> value_counts{
        {"-blendu", -1}, {"-blendv", -1}, {"-boost", 1}, {"-bm", 1}, {"-cc", -1},    {"-clamp", -1}, {"-imfchan", -1},
        {"-mm", 2},      {"-o", 3},       {"-s", 3},     {"-t", 3},  {"-texres", 1}, {"-type", -1},  {"-colorspace", -1}};
    while (text.starts_with('-')) {
        std::string_view rest = text;
        const std::string option = lower_case(take_word(rest));
        const auto entry = value_counts.find(option);
        if (entry == value_counts.end() || rest.empty()) return;  // a file name may begin with -
        std::string_view word;
        std::vector<double> numbers;
        if (entry->second < 0) word = take_word(rest);
        else numbers = take_numbers(rest, static_cast<std::size_t>(entry->second));
        if (option == "-s" || option == "-o") {
            auto& pair = option == "-s" ? statement.shift.scale : statement.shift.offset;
            for (std::size_t k = 0; k < 2 && k < numbers.size(); ++k)
                if (std::abs(numbers[k]) < 1e6) pair[k] = static_cast<float>(numbers[k]);
        } else {
            if (option == "-clamp") statement.clamp = lower_case(word) == "on";
            const bool is_default_gain = option == "-mm" && numbers == std::vector<double>{0, 1};
            const bool no_turbulence =
                option == "-t" && std::all_of(numbers.begin(), numbers.end(), [](double x) { return x == 0; });
            if (option == "-imfchan" || (option == "-mm" && !is_default_gain) || (option == "-t" && !no_turbulence))
                statement.not_applied = true;
            if (!statement.options.empty()) statement.options += ' ';
            statement.options += without_blanks(text.substr(0, text.size() - rest.size()));
        }
        text = rest;
    }
}

/// Reads the statements of MTL files.
class MaterialReader {
public:
    MaterialReader(PolygonSoup& soup, Path obj_file) : soup_(soup), obj_file_(std::move(obj_file)) {}

    void read_library(const Path& file) {
        mtl_file_ = file;
        std::string text;
        try {
            if (size_of_file(file) > max_library_bytes) fail_input(file.string(), "is larger than 64 MB");
            text = read_file(file);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            soup_.notes.push_back(fmt::format("materials are not kept: {}", error.what()));
            return;
        }
        normalise_text(text);
        for (std::size_t position = 0; position < text.size() && !is_full_;) statement(line_at(text, position));
        finish_material();
    }

    Materials finish() {
        if (repeated_ > 0)
            soup_.notes.push_back(fmt::format("{} materials have the name of an earlier one and are not kept", repeated_));
        if (clamped_ > 0)
            soup_.notes.push_back(fmt::format("{} colours of materials are out of range and were clamped", clamped_));
        if (missing_ > max_missing_images)
            soup_.notes.push_back(fmt::format("{} further images were not looked for", missing_ - max_missing_images));
        return std::move(materials_);
    }

private:
    void statement(std::string_view line) {
        std::string_view rest = without_blanks(line);
        if (rest.empty() || rest.front() == '#') return;
        const std::string_view whole_line = rest;
        const std::string keyword = lower_case(take_word(rest));
        if (keyword == "newmtl") return begin_material(name_on_line(rest));
        if (!material_) return;
        if (keyword == "kd") return diffuse_colour(rest, whole_line);
        if (keyword == "d" || keyword == "tr") return opacity(keyword, rest);
        if (auto map = parse_map_statement(whole_line)) {
            if (keyword == "map_kd") base_map_ = std::move(map);
            else maps_.push_back(std::move(*map));
            return;
        }
        const char first = keyword.front();
        if (first >= 'a' && first <= 'z' && !rest.empty()) material_->mtl_rest.emplace_back(whole_line);
    }

    void begin_material(std::string_view name) {
        finish_material();
        if (materials_.index.contains(name)) {
            ++repeated_;
            return;
        }
        if (materials_.index.size() >= max_materials) {
            soup_.notes.push_back(fmt::format("only the first {} materials are kept", max_materials));
            is_full_ = true;
            return;
        }
        material_.emplace();
        material_->name = name;
        base_map_.reset();
        maps_.clear();
        has_dissolve_ = false;
    }

    void diffuse_colour(std::string_view text, std::string_view whole_line) {
        std::string_view rest = text;
        const std::vector<double> numbers = take_numbers(rest, 3);
        if (numbers.empty()) {  // Kd spectral, Kd xyz
            material_->mtl_rest.emplace_back(whole_line);
            return;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const double value = k < numbers.size() ? numbers[k] : numbers.front();
            if (!(value >= 0 && value <= 1)) ++clamped_;
            material_->base_colour[k] = linear_from_unit_srgb(std::clamp(value, 0.0, 1.0));
        }
    }

    void opacity(const std::string& keyword, std::string_view text) {
        if (lower_case(text.substr(0, 5)) == "-halo") take_word(text);
        const std::vector<double> numbers = take_numbers(text, 1);
        if (numbers.empty() || (keyword == "tr" && has_dissolve_)) return;
        has_dissolve_ = has_dissolve_ || keyword == "d";
        double value = std::clamp(numbers.front(), 0.0, 1.0);
        // Some programs write Tr 1 for opaque materials; a material that is not seen at all would be of no use.
        if (keyword == "tr") value = value == 1 ? 1 : 1 - value;
        material_->base_colour[3] = static_cast<float>(value);
    }

    void finish_material() {
        if (!material_) return;
        Material& material = *material_;
        TextureShift shift;
        if (base_map_) {
            shift = base_map_->shift;
            material.image = image(base_map_->reference);
            if (base_map_->clamp) material.wrap_u = material.wrap_v = TextureWrap::clamp;
            if (base_map_->not_applied)
                soup_.notes.push_back(fmt::format("options of the image of material '{}' are not applied: {}",
                                                  printable(material.name, 100), printable(base_map_->options, 200)));
            base_map_->shift = {};
            if (soup_.extras.appearance.images[material.image] == nullptr) {
                material.mtl_rest.push_back(base_map_->line());
            } else if (material.base_colour[0] == 0 && material.base_colour[1] == 0 && material.base_colour[2] == 0) {
                soup_.notes.push_back(fmt::format("material '{}' has an image and the colour black: the image is shown unchanged",
                                                  printable(material.name, 100)));
                std::fill_n(material.base_colour.begin(), 3, 1.0F);
            }
        }
        for (MapStatement& map : maps_) {
            const Index index = image(map.reference);
            if (const SharedImage& kept = soup_.extras.appearance.images[index]) map.reference = kept->name;
            follow_shift(map.shift, shift);
            material.mtl_rest.push_back(map.line());
        }
        if (material.base_colour[3] < 1) material.alpha = Material::Alpha::blend;
        auto& list = soup_.extras.appearance.materials;
        materials_.index.emplace(material.name, static_cast<Index>(list.size()));
        materials_.shifts.push_back(shift);
        list.push_back(std::move(material));
        material_.reset();
    }

    /// Other maps keep their place on the surface although the texture coordinates are those of the base colour.
    static void follow_shift(TextureShift& shift, const TextureShift& applied) {
        for (std::size_t k = 0; k < 2; ++k) {
            if (applied.scale[k] == 0) continue;
            shift.scale[k] /= applied.scale[k];
            shift.offset[k] -= shift.scale[k] * applied.offset[k];
        }
    }

    /// Index of the image that the MTL file names. Each image is looked for once; a reference is relative to the folder of the
    /// MTL file, or else to that of the OBJ file.
    Index image(std::string_view text) {
        auto [entry, is_new] = image_of_reference_.try_emplace(std::pair(mtl_file_, std::string(text)), no_index);
        if (!is_new) return entry->second;
        auto& images = soup_.extras.appearance.images;
        if (missing_ >= max_missing_images) {
            ++missing_;
            images.push_back(nullptr);
            return entry->second = static_cast<Index>(images.size() - 1);
        }
        std::string reference(text);
        if (const std::string bare(name_on_line(text)); bare != reference && !bare.empty() && !place_of(reference))
            reference = bare;  // a comment behind the name
        const auto place = place_of(reference);
        entry->second = place ? add_image(soup_, place->first, place->second) : add_image(soup_, mtl_file_, reference);
        missing_ += images[entry->second] == nullptr;
        return entry->second;
    }

    /// The file beside which the image lies, and the reference from there.
    [[nodiscard]] std::optional<std::pair<Path, std::string>> place_of(const std::string& reference) const {
        if (file_beside(mtl_file_, reference)) return std::pair(mtl_file_, reference);
        const Path folder = obj_file_.parent_path();
        if (mtl_file_.parent_path() == folder || is_memory(obj_file_)) return std::nullopt;
        const std::string from_obj = (mtl_file_.parent_path().lexically_relative(folder) / reference).generic_string();
        if (file_beside(obj_file_, from_obj)) return std::pair(obj_file_, from_obj);
        if (file_beside(obj_file_, reference)) return std::pair(obj_file_, reference);
        return std::nullopt;
    }

    PolygonSoup& soup_;
    Path obj_file_, mtl_file_;
    Materials materials_;
    std::optional<Material> material_;  ///< the material that is being read
    std::optional<MapStatement> base_map_;
    std::vector<MapStatement> maps_;
    std::map<std::pair<Path, std::string>, Index> image_of_reference_;
    bool has_dissolve_ = false, is_full_ = false;
    std::size_t repeated_ = 0, clamped_ = 0, missing_ = 0;
};

/// The names of MTL files on a line that has several: each ends with the extension .mtl.
std::vector<std::string> library_names(std::string_view line) {
    std::vector<std::string> names;
    std::size_t begin = 0;
    for (std::size_t position = 0; position < line.size();) {
        const std::size_t end = std::min(line.find_first_of(" \t\v\r\f", position), line.size());
        const std::string_view word = line.substr(position, end - position);
        position = end + 1;
        if (word.size() < 4 || lower_case(word.substr(word.size() - 4)) != ".mtl") continue;
        names.emplace_back(without_blanks(line.substr(begin, end - begin)));
        begin = position;
    }
    if (begin < line.size() && !without_blanks(line.substr(begin)).empty())
        names.emplace_back(without_blanks(line.substr(begin)));
    return names;
}

/// The MTL files that an OBJ file names, and notes about those that do not exist.
std::vector<Path> library_files(const Path& obj_file, const std::vector<std::string_view>& lines, bool is_used, Notes& notes) {
    std::vector<Path> files;
    const auto add = [&files](const Path& file) {
        if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
    };
    std::vector<std::string> missing;
    std::set<std::string_view> distinct_lines(lines.begin(), lines.end());
    std::size_t looked_for = 0;
    for (const std::string_view line : lines) {
        if (distinct_lines.erase(line) == 0) continue;
        if (++looked_for > max_libraries) {
            notes.push_back(fmt::format("only the first {} MTL files are read", max_libraries));
            break;
        }
        const std::string whole(without_blanks(line)), name(name_on_line(line));
        auto file = file_beside(obj_file, whole);
        if (!file) file = file_beside(obj_file, name);
        if (file) {
            add(*file);
            continue;
        }
        for (const std::string& part : library_names(name)) {
            if (++looked_for > max_libraries) break;
            if (const auto library = file_beside(obj_file, part)) add(*library);
            else missing.push_back(part);
        }
    }
    if (missing.empty() && !(files.empty() && is_used)) return files;
    const std::string own_name = obj_file.stem().string() + ".mtl";
    const auto own_file = files.empty() ? file_beside(obj_file, own_name) : std::nullopt;
    if (own_file) {
        files.push_back(*own_file);
        notes.push_back(fmt::format("the materials are those of {}", printable(own_file->filename().string(), 200)));
    }
    if (missing.size() > 20) missing.resize(20);
    if (!missing.empty())
        notes.push_back(
            fmt::format("the MTL file that the file names is not in its folder: {}", printable(joined(missing), 1000)));
    return files;
}

}  // namespace

std::string MapStatement::line() const {
    std::string text = keyword;
    if (!options.empty()) text += " " + options;
    if (shift.offset != std::array<float, 2>{0, 0}) text += fmt::format(" -o {} {}", shift.offset[0], shift.offset[1]);
    if (shift.scale != std::array<float, 2>{1, 1}) text += fmt::format(" -s {} {}", shift.scale[0], shift.scale[1]);
    return text + " " + reference;
}

std::optional<MapStatement> parse_map_statement(std::string_view line) {
    MapStatement statement;
    std::string_view rest = line;
    statement.keyword = take_word(rest);
    if (!is_map_keyword(statement.keyword)) return std::nullopt;
    take_options(rest, statement);
    if (rest.size() > 1 && rest.front() == '"' && rest.back() == '"') rest = rest.substr(1, rest.size() - 2);
    if (rest.empty()) return std::nullopt;
    statement.reference = rest;
    return statement;
}

std::string_view name_on_line(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '#' && (i == 0 || is_blank_character(text[i - 1]))) text = text.substr(0, i);
    return without_blanks(text);
}

float linear_from_unit_srgb(double value) {
    return static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
}

std::string missing_image(const Material& material) {
    for (const std::string& line : material.mtl_rest)
        if (const auto map = parse_map_statement(line); map && lower_case(map->keyword) == "map_kd") return map->reference;
    return {};
}

Materials read_materials(PolygonSoup& soup, const Path& obj_file, const std::vector<std::string_view>& libraries, bool is_used) {
    MaterialReader reader(soup, obj_file);
    for (const Path& file : library_files(obj_file, libraries, is_used, soup.notes)) reader.read_library(file);
    return reader.finish();
}

}  // namespace ostraka::io
