#include "io/three_mf.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"

#include <expat.h>
#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <exception>
#include <functional>
#include <optional>
#include <set>

namespace ostraka::io {

namespace {

/// An XML element and its attributes; prefixes of namespaces are left out.
class XmlElement {
public:
    XmlElement(const char* name, const char** attributes) : name_(without_prefix(name)), attributes_(attributes) {}
    [[nodiscard]] std::string_view name() const { return name_; }
    /// The value of an attribute; nullopt if there is none.
    [[nodiscard]] std::optional<std::string_view> text(std::string_view attribute) const {
        for (const char** entry = attributes_; *entry != nullptr; entry += 2)
            if (without_prefix(entry[0]) == attribute) return entry[1];
        return std::nullopt;
    }
    static std::string_view without_prefix(std::string_view name) {
        const std::size_t colon = name.rfind(':');
        return colon == std::string_view::npos ? name : name.substr(colon + 1);
    }

private:
    std::string_view name_;
    const char** attributes_;
};

/// Parses an XML part of the archive as a stream, so that its text is never in memory as a whole.
class XmlStream {
public:
    using Handler = std::function<void(const XmlElement&)>;
    XmlStream(std::string where, Handler begin, std::function<void(std::string_view)> end)
        : where_(std::move(where)), begin_(std::move(begin)), end_(std::move(end)), parser_(XML_ParserCreate(nullptr)) {
        if (parser_ == nullptr) throw std::bad_alloc();
        XML_SetUserData(parser_, this);
        XML_SetElementHandler(parser_, on_begin, on_end);
        XML_SetStartDoctypeDeclHandler(parser_, on_doctype);
    }
    ~XmlStream() { XML_ParserFree(parser_); }
    XmlStream(const XmlStream&) = delete;
    XmlStream& operator=(const XmlStream&) = delete;

    void parse(const ZipArchive& archive, const std::string& part) {
        bool is_valid = true;
        archive.stream(part, [&](std::string_view piece) {
            is_valid = XML_Parse(parser_, piece.data(), static_cast<int>(piece.size()), 0) == XML_STATUS_OK;
            return is_valid;
        });
        if (is_valid) is_valid = XML_Parse(parser_, "", 0, 1) == XML_STATUS_OK;
        if (error_) std::rethrow_exception(error_);
        if (!is_valid) fail(fmt::format("is not valid XML: {}", XML_ErrorString(XML_GetErrorCode(parser_))));
    }
    [[noreturn]] void fail(const std::string& problem) const {
        fail_input(fmt::format("{}, line {}", where_, XML_GetCurrentLineNumber(parser_)), problem, "export the file again");
    }

private:
    /// No exception may pass the parser, which is written in C: it is kept and thrown when the parser has stopped.
    template <class Work>
    void guarded(const Work& work) {
        if (error_) return;
        try {
            work();
        } catch (...) {
            error_ = std::current_exception();
            XML_StopParser(parser_, XML_FALSE);
        }
    }
    static void on_begin(void* self, const char* name, const char** attributes) {
        auto& stream = *static_cast<XmlStream*>(self);
        stream.guarded([&] {
            if (++stream.depth_ > max_depth) stream.fail("has elements nested deeper than 100 levels");
            stream.begin_(XmlElement(name, attributes));
        });
    }
    static void on_end(void* self, const char* name) {
        auto& stream = *static_cast<XmlStream*>(self);
        --stream.depth_;
        stream.guarded([&] { stream.end_(XmlElement::without_prefix(name)); });
    }
    static void on_doctype(void* self, const char*, const char*, const char*, int) {
        auto& stream = *static_cast<XmlStream*>(self);
        stream.guarded([&] { stream.fail("has a document type, which 3MF forbids"); });
    }

    static constexpr int max_depth = 100;
    std::string where_;
    Handler begin_;
    std::function<void(std::string_view)> end_;
    XML_Parser parser_;
    std::exception_ptr error_;
    int depth_ = 0;
};

/// A group of properties to which triangles refer by its number and the number of an entry.
struct PropertyGroup {
    std::vector<Colour> colours;
    std::vector<TexturePoint> coordinates;
    Index texture = no_index;
};

/// Reads one model part.
class ModelPart {
public:
    ModelPart(Model& model, std::string part, const std::string& file, std::size_t& room)
        : model_(model),
          part_(std::move(part)),
          room_(room),
          stream_(
              fmt::format("{}, {}", file, printable(part_, 200)), [this](const XmlElement& element) { begin(element); },
              [this](std::string_view name) { end(name); }) {}

    /// Names of further parts to which this one refers.
    std::set<std::string> read(const ZipArchive& archive) {
        stream_.parse(archive, part_);
        return std::move(other_parts_);
    }

    std::size_t shaded = 0;  ///< number of triangles with different colours at their corners
    std::set<std::string> not_kept;

private:
    void begin(const XmlElement& element) {
        const std::string_view name = element.name();
        if (name == "vertex") vertex(element);
        else if (name == "triangle") triangle(element);
        else if (name == "component") component(element);
        else if (name == "item") model_.build.push_back(placed(element));
        else if (name == "object") begin_object(element);
        else if (name == "base" || name == "color") colour(element);
        else if (name == "tex2coord") texture_coordinates(element);
        else if (name == "basematerials" || name == "colorgroup" || name == "texture2dgroup") begin_group(element);
        else if (name == "texture2d") texture(element);
        else if (name == "model") model_.unit = printable(std::string(element.text("unit").value_or(model_.unit)), 30);
        else if (name == "compositematerials" || name == "multiproperties" || name == "beamlattice" || name == "slicestack")
            not_kept.emplace(name);
    }

    void end(std::string_view name) {
        if (name != "object" || object_ == nullptr) return;
        for (const auto& corners : object_->triangles)
            for (const Index v : corners)
                if (v >= object_->points.size())
                    stream_.fail(fmt::format("a triangle names vertex {} of {}", v, object_->points.size()));
        complete(object_->colours, white);
        complete(object_->textures, no_index);
        complete(object_->coordinates, {});
        object_ = nullptr;
    }

    template <class Value>
    void complete(std::vector<Value>& values, const Value& missing) const {
        if (!values.empty()) values.resize(object_->triangles.size(), missing);
    }

    /// Accounts for memory before it is allocated.
    void take(std::size_t bytes) {
        if (bytes > room_) stream_.fail("unpacks to more elements than a file of this size may hold");
        room_ -= bytes;
    }

    double number(const XmlElement& element, std::string_view attribute) const {
        const auto text = element.text(attribute);
        const auto value = text ? number_of(*text) : std::nullopt;
        if (!value) stream_.fail(fmt::format("{} of a {} is missing or not a finite number", attribute, element.name()));
        return *value;
    }

    /// A whole number from 0; nullopt if there is no such attribute.
    std::optional<std::uint32_t> whole(const XmlElement& element, std::string_view attribute) const {
        const auto text = element.text(attribute);
        if (!text) return std::nullopt;
        std::uint32_t value = 0;
        const std::string_view digits_only = trimmed(*text);
        const auto [stop, code] = std::from_chars(digits_only.data(), digits_only.data() + digits_only.size(), value);
        if (code != std::errc() || stop != digits_only.data() + digits_only.size() || value == no_index)
            stream_.fail(fmt::format("{} of a {} is not a whole number", attribute, element.name()));
        return value;
    }
    std::uint32_t required(const XmlElement& element, std::string_view attribute) const {
        const auto value = whole(element, attribute);
        if (!value) stream_.fail(fmt::format("a {} has no {}", element.name(), attribute));
        return *value;
    }

    void begin_object(const XmlElement& element) {
        take(512);
        const ObjectKey key(part_, required(element, "id"));
        const auto [entry, is_new] = model_.objects.try_emplace(key);
        if (!is_new) stream_.fail(fmt::format("object {} is defined twice", key.second));
        object_ = &entry->second;
        object_group_ = whole(element, "pid");
        object_index_ = whole(element, "pindex").value_or(0);
    }

    void vertex(const XmlElement& element) {
        if (object_ == nullptr) return;
        take(2 * sizeof(std::array<double, 3>));
        object_->points.push_back({number(element, "x"), number(element, "y"), number(element, "z")});
    }

    void triangle(const XmlElement& element) {
        if (object_ == nullptr) return;
        take(2 * sizeof(std::array<Index, 3>));
        object_->triangles.push_back({required(element, "v1"), required(element, "v2"), required(element, "v3")});
        auto pid = whole(element, "pid");
        auto p1 = whole(element, "p1");
        if (!p1) {
            pid = object_group_;
            p1 = object_index_;
        } else if (!pid) {
            pid = object_group_;
        }
        const auto group = pid ? groups_.find(*pid) : groups_.end();
        if (group == groups_.end()) return;
        properties(group->second, {*p1, whole(element, "p2").value_or(*p1), whole(element, "p3").value_or(*p1)});
    }

    void properties(const PropertyGroup& group, const std::array<std::uint32_t, 3>& entries) {
        const std::size_t count = object_->triangles.size();
        const std::size_t size = std::max(group.colours.size(), group.coordinates.size());
        for (const std::uint32_t entry : entries)
            if (entry >= size) stream_.fail(fmt::format("a triangle names property {} of {}", entry, size));
        if (!group.colours.empty()) {
            take(2 * sizeof(Colour) * (count - object_->colours.size()));
            object_->colours.resize(count, white);
            object_->colours.back() = group.colours[entries[0]];
            shaded +=
                group.colours[entries[1]] != group.colours[entries[0]] || group.colours[entries[2]] != group.colours[entries[0]];
        } else {
            take(2 * (sizeof(Index) + 3 * sizeof(TexturePoint)) * (count - object_->textures.size()));
            object_->textures.resize(count, no_index);
            object_->coordinates.resize(count);
            object_->textures.back() = group.texture;
            for (std::size_t k = 0; k < 3; ++k) object_->coordinates.back()[k] = group.coordinates[entries[k]];
        }
    }

    void component(const XmlElement& element) {
        if (object_ == nullptr) return;
        take(2 * sizeof(PlacedObject) + part_.size());
        object_->components.push_back(placed(element));
    }

    PlacedObject placed(const XmlElement& element) {
        PlacedObject result{{part_, required(element, "objectid")}, no_placement};
        if (const auto path = element.text("path")) {
            result.object.first = part_name(*path);
            other_parts_.insert(result.object.first);
            take(result.object.first.size() + 200);
        }
        if (const auto text = element.text("transform")) {
            const auto words = split_words(*text);
            if (words.size() != 12) stream_.fail("a transform does not have twelve numbers");
            for (std::size_t k = 0; k < 12; ++k) {
                const auto value = number_of(words[k]);
                if (!value) stream_.fail("a transform has a value that is not a finite number");
                result.placement[k] = *value;
            }
        }
        return result;
    }

    void begin_group(const XmlElement& element) {
        take(512);
        group_ = &groups_[required(element, "id")];
        if (const auto id = whole(element, "texid")) {
            const auto entry = texture_of_id_.find(*id);
            if (entry == texture_of_id_.end())
                stream_.fail(fmt::format("a texture2dgroup names texture {}, which is missing", *id));
            group_->texture = entry->second;
        }
    }

    void colour(const XmlElement& element) {
        if (group_ == nullptr) return;
        take(2 * sizeof(Colour));
        const std::string_view text = element.text(element.name() == "base" ? "displaycolor" : "color").value_or("");
        Colour result = white;
        const bool is_colour = (text.size() == 7 || text.size() == 9) && text[0] == '#';
        for (std::size_t k = 0; is_colour && k < (text.size() - 1) / 2; ++k) {
            const char* digits_of_channel = text.data() + 1 + 2 * k;
            const auto [stop, code] = std::from_chars(digits_of_channel, digits_of_channel + 2, result[k], 16);
            if (code != std::errc() || stop != digits_of_channel + 2) stream_.fail("a colour is not of the form #RRGGBB");
        }
        if (!is_colour && !text.empty()) stream_.fail("a colour is not of the form #RRGGBB");
        group_->colours.push_back(result);
    }

    void texture_coordinates(const XmlElement& element) {
        if (group_ == nullptr) return;
        take(2 * sizeof(TexturePoint));
        TexturePoint point{static_cast<float>(number(element, "u")), static_cast<float>(number(element, "v"))};
        if (!std::isfinite(point[0]) || !std::isfinite(point[1])) stream_.fail("a texture coordinate does not fit a float");
        group_->coordinates.push_back(point);
    }

    void texture(const XmlElement& element) {
        take(512);
        const auto wrap = [&](const char* attribute) {
            const std::string_view style = element.text(attribute).value_or("wrap");
            return style == "mirror" ? TextureWrap::mirror : style == "wrap" ? TextureWrap::repeat : TextureWrap::clamp;
        };
        texture_of_id_[required(element, "id")] = static_cast<Index>(model_.textures.size());
        model_.textures.push_back({part_name(element.text("path").value_or("")), wrap("tilestyleu"), wrap("tilestylev"),
                                   element.text("filter") == "nearest"});
    }

    Model& model_;
    std::string part_;
    std::size_t& room_;
    XmlStream stream_;
    ModelObject* object_ = nullptr;  ///< the object that is being read
    std::optional<std::uint32_t> object_group_;
    std::uint32_t object_index_ = 0;
    PropertyGroup* group_ = nullptr;
    std::map<std::uint32_t, PropertyGroup> groups_;
    std::map<std::uint32_t, Index> texture_of_id_;
    std::set<std::string> other_parts_;
};

/// The model part that the relationships of the archive name.
std::string root_part(const ZipArchive& archive, const std::string& file) {
    std::string part;
    const std::string relationships = "_rels/.rels";
    if (archive.has(relationships)) {
        XmlStream stream(
            file + ", " + relationships,
            [&](const XmlElement& element) {
                const std::string_view type = element.text("Type").value_or("");
                if (part.empty() && element.name() == "Relationship" && type.ends_with("/3dmodel"))
                    part = part_name(element.text("Target").value_or(""));
            },
            [](std::string_view) {});
        stream.parse(archive, relationships);
    }
    return part.empty() ? "3D/3dmodel.model" : part;
}

}  // namespace

Model read_model(const ZipArchive& archive, const std::string& file, std::size_t max_bytes) {
    constexpr std::size_t max_parts = 10000;
    Model model;
    std::size_t shaded = 0;
    std::set<std::string> read_parts, waiting{root_part(archive, file)}, not_kept;
    while (!waiting.empty()) {
        const std::string part = *waiting.begin();
        waiting.erase(waiting.begin());
        if (!read_parts.insert(part).second) continue;
        if (read_parts.size() > max_parts) fail_input(file, "has more than 10000 model parts");
        const std::size_t build_items = model.build.size();
        ModelPart reader(model, part, file, max_bytes);
        waiting.merge(reader.read(archive));
        if (read_parts.size() > 1) model.build.resize(build_items);  // only the root has a build
        shaded += reader.shaded;
        not_kept.merge(reader.not_kept);
    }
    if (shaded > 0)
        model.notes.push_back(
            fmt::format("{} triangles have different colours at their corners and were given that of the first one", shaded));
    if (!not_kept.empty()) model.notes.push_back("3MF elements not kept: " + joined(not_kept));
    return model;
}

}  // namespace ostraka::io
