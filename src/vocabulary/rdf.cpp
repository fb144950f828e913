#include "vocabulary/rdf.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/files/json.h"

#include <raptor.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <new>

namespace ostraka {

namespace {

struct RaptorDeleter {
    void operator()(raptor_world* world) const { raptor_free_world(world); }
    void operator()(raptor_parser* parser) const { raptor_free_parser(parser); }
    void operator()(raptor_serializer* serializer) const { raptor_free_serializer(serializer); }
    void operator()(raptor_uri* uri) const { raptor_free_uri(uri); }
    void operator()(raptor_statement* statement) const { raptor_free_statement(statement); }
};
template <class T>
using Owned = std::unique_ptr<T, RaptorDeleter>;

/// Raptor and its XML library have global state.
std::mutex& library_mutex() {
    static std::mutex mutex;
    return mutex;
}

const unsigned char* bytes(const std::string& text) { return reinterpret_cast<const unsigned char*>(text.c_str()); }

[[noreturn]] void no_memory() { fail_work("RDF", "the library cannot be used: out of memory"); }

/// Error log of the library; keeps the first error.
struct Log {
    std::string text;
    int line = -1;
    static void write(void* self, raptor_log_message* message) {
        auto& log = *static_cast<Log*>(self);
        if (message->level < RAPTOR_LOG_LEVEL_ERROR || !log.text.empty()) return;
        try {
            log.text = message->text == nullptr ? "unknown reason" : message->text;
        } catch (const std::bad_alloc&) {
            return;
        }
        if (message->locator != nullptr) log.line = message->locator->line;
    }
};

Owned<raptor_world> open_world(Log& log) {
    Owned<raptor_world> world(raptor_new_world());
    if (!world) no_memory();
    raptor_world_set_log_handler(world.get(), &log, &Log::write);
    if (raptor_world_open(world.get()) != 0) no_memory();
    return world;
}

std::string text_of_uri(raptor_uri* uri) {
    std::size_t length = 0;
    const unsigned char* text = raptor_uri_as_counted_string(uri, &length);
    return {reinterpret_cast<const char*>(text), length};
}

RdfTerm value_of(const raptor_term* term) {
    if (term->type == RAPTOR_TERM_TYPE_URI) return {RdfTerm::Kind::uri, text_of_uri(term->value.uri), {}, {}};
    if (term->type == RAPTOR_TERM_TYPE_BLANK)
        return {RdfTerm::Kind::blank,
                {reinterpret_cast<const char*>(term->value.blank.string), term->value.blank.string_len},
                {},
                {}};
    const auto& literal = term->value.literal;
    RdfTerm value{RdfTerm::Kind::text, {reinterpret_cast<const char*>(literal.string), literal.string_len}, {}, {}};
    if (literal.language != nullptr) value.language.assign(reinterpret_cast<const char*>(literal.language), literal.language_len);
    if (literal.datatype != nullptr) value.datatype = text_of_uri(literal.datatype);
    if (value.datatype == "http://www.w3.org/2001/XMLSchema#string") value.datatype.clear();  // equivalent in RDF 1.1
    return value;
}

/// Collects statements and limits their memory: prefixes, bases and entities stand for texts of any length, so that a short
/// file may expand without bound.
struct Collector {
    explicit Collector(std::size_t bytes_of_file) : max_bytes(12.0 * static_cast<double>(bytes_of_file) + 256e6) {}
    double max_bytes, used_bytes = 0;
    raptor_parser* parser = nullptr;
    std::vector<RdfStatement> statements;
    bool out_of_memory = false, too_large = false;

    static double size_of(const RdfTerm& term) {
        return static_cast<double>(term.value.size() + term.language.size() + term.datatype.size());
    }
    // Exceptions must not propagate through the C library.
    static void add(void* self, raptor_statement* statement) noexcept {
        auto& collector = *static_cast<Collector*>(self);
        if (collector.too_large) return;
        try {
            const RdfStatement& added = collector.statements.emplace_back(RdfStatement{
                value_of(statement->subject), text_of_uri(statement->predicate->value.uri), value_of(statement->object)});
            collector.used_bytes += static_cast<double>(2 * sizeof(RdfStatement) + added.predicate.size()) +
                                    size_of(added.subject) + size_of(added.object);
            if (collector.used_bytes <= collector.max_bytes) return;
            collector.too_large = true;
            std::vector<RdfStatement>().swap(collector.statements);
            raptor_parser_parse_abort(collector.parser);
        } catch (const std::bad_alloc&) {
            collector.out_of_memory = true;
        }
    }
};

int line_of(std::string_view text, std::size_t offset) {
    return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
}

[[noreturn]] void fail_at(const std::string& where, int line, const std::string& problem, const std::string& remedy) {
    fail_input(line > 0 ? fmt::format("{}, line {}", where, line) : where, problem, remedy);
}

/// Both syntaxes are restricted to UTF-8, so that no other encoding can bypass the checks below.
void require_utf8(const std::string& text, const std::string& where) {
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = text[i] == 0 ? 0 : utf8_length(text, i);
        if (length == 0) fail_at(where, line_of(text, i), "the text is not UTF-8", "save the file as UTF-8");
        i += length;
    }
}

/// Rejects text in which many references to short entities expand to far more than the size of the file.
void refuse_many_entities(const std::string& text, const std::map<std::string, std::size_t>& lengths, const std::string& where) {
    const std::size_t max_size = 4 * text.size() + 16'000'000;
    std::size_t sum = 0;
    for (std::size_t position = text.find('&'); position != std::string::npos; position = text.find('&', position + 1)) {
        const std::size_t end = text.find_first_of("; \n<&", position + 1);
        if (end == std::string::npos || text[end] != ';') continue;
        const auto entity = lengths.find(text.substr(position + 1, std::min<std::size_t>(end - position - 1, 1000)));
        if (entity != lengths.end() && (sum += entity->second) > max_size)
            fail_at(where, line_of(text, position), "its entities expand to many times the size of the file",
                    "replace them by their texts");
    }
}

/// Entities for plain text are common in RDF/XML and allowed; entities that read other files or that contain entities are
/// rejected.
void refuse_dangerous_entities(const std::string& text, const std::string& where) {
    const auto upper = [](std::string fragment) {
        for (char& c : fragment) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        return fragment;
    };
    if (text.starts_with("<?xml")) {
        const std::string head = upper(text.substr(0, std::min(text.find("?>"), std::size_t{1000})));
        if (const std::size_t position = head.find("ENCODING"); position != std::string::npos)
            if (head.find("UTF-8", position) == std::string::npos && head.find("US-ASCII", position) == std::string::npos)
                fail_at(where, 1, "the file declares an encoding other than UTF-8", "save the file as UTF-8");
    }
    std::size_t position = text.find("<!DOCTYPE");
    if (position == std::string::npos) return;
    const std::size_t bracket = text.find_first_of("[>", position);
    const std::string name = upper(text.substr(position, std::min(bracket, text.size()) - position));
    if (name.find("SYSTEM") != std::string::npos || name.find("PUBLIC") != std::string::npos)
        fail_at(where, line_of(text, position), "the document type is defined in another file",
                "remove the document type declaration");
    std::map<std::string, std::size_t> lengths;
    while ((position = text.find("<!ENTITY", position)) != std::string::npos) {
        const int line = line_of(text, position);
        const std::size_t quote = text.find_first_of("\"'", position);
        const std::size_t end = quote == std::string::npos ? quote : text.find(text[quote], quote + 1);
        if (end == std::string::npos) fail_at(where, line, "an entity does not end", "correct or regenerate the file");
        const std::string head = upper(text.substr(position, quote - position)), value = text.substr(quote + 1, end - quote - 1);
        if (head.find("SYSTEM") != std::string::npos || head.find("PUBLIC") != std::string::npos)
            fail_at(where, line, "an entity is defined in another file", "replace it by its text");
        if (head.find('%') != std::string::npos || value.find('%') != std::string::npos || value.find('&') != std::string::npos)
            fail_at(where, line, "an entity contains other entities", "replace it by its text");
        if (value.size() > 1000) fail_at(where, line, "an entity expands to more than 1000 bytes", "replace it by its text");
        const std::size_t name_at = text.find_first_not_of(" \t\r\n", position + 8);
        const std::size_t name_end = text.find_first_of(" \t\r\n\"'", name_at);
        lengths[text.substr(name_at, name_end - name_at)] = value.size();
        position = end;
    }
    if (!lengths.empty()) refuse_many_entities(text, lengths, where);
}

/// The parser's time is quadratic in the nesting depth, which is therefore limited. Malformed XML is left to the parser.
void refuse_deep_nesting(const std::string& text, const std::string& where) {
    const auto end_of = [&](const char* delimiter, std::size_t offset) {
        const std::size_t position = text.find(delimiter, offset);
        return position == std::string::npos ? text.size() : position + std::strlen(delimiter);
    };
    std::size_t depth = 0;
    for (std::size_t i = text.find('<'); i < text.size(); i = text.find('<', i)) {
        if (text.compare(i, 4, "<!--") == 0) i = end_of("-->", i);
        else if (text.compare(i, 9, "<![CDATA[") == 0) i = end_of("]]>", i);
        else if (text.compare(i, 2, "<?") == 0) i = end_of("?>", i);
        else if (text.compare(i, 2, "<!") == 0) ++i;
        else if (text.compare(i, 2, "</") == 0) depth -= depth > 0 ? 1 : 0, ++i;
        else {
            const std::size_t start = i;
            char quote = 0;
            for (++i; i < text.size() && (quote != 0 || text[i] != '>'); ++i) {
                if (quote == 0 && (text[i] == '"' || text[i] == '\'')) quote = text[i];
                else if (text[i] == quote) quote = 0;
            }
            if (text[i - 1] != '/' && ++depth > 1000)
                fail_at(where, line_of(text, start), "elements are nested deeper than 1000", "flatten the file");
        }
    }
}

void require_uri(const std::string& uri, const std::string& where) {
    const std::size_t colon = uri.find(':');
    bool valid = colon != std::string::npos && colon > 0 && std::isalpha(static_cast<unsigned char>(uri.front())) != 0;
    for (std::size_t i = 0; valid && i < colon; ++i)
        valid = std::isalnum(static_cast<unsigned char>(uri[i])) != 0 || uri[i] == '+' || uri[i] == '-' || uri[i] == '.';
    for (const char c : uri)
        valid =
            valid && static_cast<unsigned char>(c) > 32 && std::string_view("<>\"{}|^`\\\x7F").find(c) == std::string_view::npos;
    if (!valid) fail_input(where, fmt::format("'{}' is not a URI", uri), "give a URI such as https://example.org/vocabulary");
}

void require_text(const std::string& text, RdfSyntax syntax, const std::string& where) {
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte == 0 || (syntax == RdfSyntax::rdf_xml && byte < 32 && c != '\n' && c != '\t' && c != '\r'))
            fail_input(where,
                       fmt::format("a text contains a control character, which {} cannot represent",
                                   syntax == RdfSyntax::turtle ? "Turtle" : "RDF/XML"),
                       "remove the character");
    }
}

raptor_term* new_term(raptor_world* world, const RdfTerm& term) {
    switch (term.kind) {
        case RdfTerm::Kind::uri:
            return raptor_new_term_from_counted_uri_string(world, bytes(term.value), term.value.size());
        case RdfTerm::Kind::blank:
            return raptor_new_term_from_counted_blank(world, bytes(term.value), term.value.size());
        case RdfTerm::Kind::text:
            break;
    }
    const Owned<raptor_uri> datatype(term.datatype.empty() ? nullptr : raptor_new_uri(world, bytes(term.datatype)));
    return raptor_new_term_from_counted_literal(world, bytes(term.value), term.value.size(), datatype.get(),
                                                term.language.empty() ? nullptr : bytes(term.language),
                                                static_cast<unsigned char>(term.language.size()));
}

}  // namespace

std::vector<RdfStatement> parse_rdf(const std::string& text, RdfSyntax syntax, const std::string& base,
                                    const std::string& where) {
    const bool xml = syntax == RdfSyntax::rdf_xml;
    require_utf8(text, where);
    if (xml) {
        refuse_dangerous_entities(text, where);
        refuse_deep_nesting(text, where);
    }
    const std::lock_guard lock(library_mutex());
    Log log;
    Collector collector(text.size());
    const Owned<raptor_world> world = open_world(log);
    const Owned<raptor_parser> parser(raptor_new_parser(world.get(), xml ? "rdfxml" : "turtle"));
    const Owned<raptor_uri> base_uri(raptor_new_uri(world.get(), bytes(base)));
    if (!parser || !base_uri) no_memory();
    raptor_parser_set_option(parser.get(), RAPTOR_OPTION_NO_NET, nullptr, 1);
    raptor_parser_set_option(parser.get(), RAPTOR_OPTION_NO_FILE, nullptr, 1);
    raptor_parser_set_option(parser.get(), RAPTOR_OPTION_LOAD_EXTERNAL_ENTITIES, nullptr, 0);
    raptor_parser_set_option(parser.get(), RAPTOR_OPTION_NORMALIZE_LANGUAGE, nullptr, 0);
    collector.parser = parser.get();
    raptor_parser_set_statement_handler(parser.get(), &collector, &Collector::add);
    int result = raptor_parser_parse_start(parser.get(), base_uri.get());
    // The XML library accepts at most ten million bytes at once.
    const std::size_t chunk_size = xml ? std::min<std::size_t>(65536, text.size()) : text.size();
    for (std::size_t offset = 0; result == 0 && !collector.too_large && offset + chunk_size < text.size(); offset += chunk_size)
        result = raptor_parser_parse_chunk(parser.get(), bytes(text) + offset, chunk_size, 0);
    const std::size_t last = text.empty() ? 0 : (text.size() - 1) / chunk_size * chunk_size;
    if (result == 0 && !collector.too_large)
        result = raptor_parser_parse_chunk(parser.get(), bytes(text) + last, text.size() - last, 1);
    if (collector.out_of_memory) throw std::bad_alloc();
    if (collector.too_large)
        fail_input(where,
                   fmt::format("its statements take more than {} MB, many times the size of the file: prefixes, bases or "
                               "entities expand to long texts",
                               digits(collector.max_bytes / 1e6, 3)),
                   "shorten them, or split the file");
    if (result == 0 && log.text.empty()) return std::move(collector.statements);
    if (log.line < 0)
        if (const raptor_locator* locator = raptor_parser_get_locator(parser.get())) log.line = locator->line;
    fail_at(where, log.line,
            std::string(xml ? "not valid RDF/XML: " : "not valid Turtle: ") + (log.text.empty() ? "unknown reason" : log.text),
            "correct or regenerate the file");
}

std::string serialise_rdf(const std::vector<RdfStatement>& statements, RdfSyntax syntax,
                          const std::vector<std::pair<std::string, std::string>>& prefixes, const std::string& where) {
    for (const RdfStatement& statement : statements) {
        require_uri(statement.predicate, where);
        for (const RdfTerm* term : {&statement.subject, &statement.object}) {
            if (term->kind == RdfTerm::Kind::uri) require_uri(term->value, where);
            if (!term->datatype.empty()) require_uri(term->datatype, where);
            if (term->kind == RdfTerm::Kind::text) require_text(term->value, syntax, where);
        }
    }
    const std::lock_guard lock(library_mutex());
    Log log;
    const Owned<raptor_world> world = open_world(log);
    const Owned<raptor_serializer> serializer(
        raptor_new_serializer(world.get(), syntax == RdfSyntax::turtle ? "turtle" : "rdfxml-abbrev"));
    if (!serializer) no_memory();
    void* memory = nullptr;
    std::size_t length = 0;
    for (const auto& [prefix, name] : prefixes) {
        const Owned<raptor_uri> uri(raptor_new_uri(world.get(), bytes(name)));
        raptor_serializer_set_namespace(serializer.get(), uri.get(), bytes(prefix));
    }
    int result = raptor_serializer_start_to_string(serializer.get(), nullptr, &memory, &length);
    for (const RdfStatement& statement : statements) {
        if (result != 0) break;
        const Owned<raptor_statement> triple(raptor_new_statement_from_nodes(
            world.get(), new_term(world.get(), statement.subject),
            raptor_new_term_from_counted_uri_string(world.get(), bytes(statement.predicate), statement.predicate.size()),
            new_term(world.get(), statement.object), nullptr));
        if (!triple) no_memory();
        result = raptor_serializer_serialize_statement(serializer.get(), triple.get());
    }
    if (result == 0) result = raptor_serializer_serialize_end(serializer.get());
    std::string text(static_cast<const char*>(memory), memory == nullptr ? 0 : length);
    if (memory != nullptr) raptor_free_memory(memory);
    if (result != 0 || !log.text.empty() || text.empty())
        fail_work(where, "cannot be written: " + (log.text.empty() ? "unknown reason" : log.text));
    return text;
}

}  // namespace ostraka
