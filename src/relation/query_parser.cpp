#include "relation/query_parser.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/vocabulary/text_match.h"

#include <charconv>
#include <cmath>

namespace ostraka::detail {

namespace {

using QueryNode = AnnotationQuery::Node;
using NodePointer = std::unique_ptr<QueryNode>;
using NodeKind = QueryNode::Kind;

struct QueryToken {
    enum class Kind { end, number, name, quoted, sign } kind = Kind::end;
    std::string text;
    double value = 0;
    std::size_t at = 1;
};

[[noreturn]] void fail_query(std::size_t at, const std::string& what, const std::string& remedy) {
    fail_usage("query, column " + std::to_string(at) + ": " + what, remedy);
}

bool name_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (static_cast<unsigned char>(c) & 0x80) != 0;
}

std::vector<QueryToken> query_tokens(const std::string& text) {
    std::vector<QueryToken> tokens;
    std::size_t i = 0;
    while (i < text.size()) {
        const char c = text[i];
        const std::size_t begin = i;
        if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
            ++i;
        } else if (name_letter(c)) {
            while (i < text.size() && (name_letter(text[i]) || (text[i] >= '0' && text[i] <= '9'))) ++i;
            tokens.push_back({QueryToken::Kind::name, text.substr(begin, i - begin), 0, begin + 1});
        } else if ((c >= '0' && c <= '9') || (c == '.' && i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9')) {
            double value = 0;
            const auto [end, code] = std::from_chars(text.data() + i, text.data() + text.size(), value);
            if (code != std::errc() || !std::isfinite(value))
                fail_query(begin + 1, "a number that is not finite", "write it smaller");
            i = static_cast<std::size_t>(end - text.data());
            tokens.push_back({QueryToken::Kind::number, text.substr(begin, i - begin), value, begin + 1});
        } else if (c == '"' || c == '\'') {
            const std::size_t end = text.find(c, i + 1);
            if (end == std::string::npos) fail_query(begin + 1, "a quotation mark is not closed", "close it");
            tokens.push_back({QueryToken::Kind::quoted, text.substr(i + 1, end - i - 1), 0, begin + 1});
            if (tokens.back().text.empty()) fail_query(begin + 1, "nothing is quoted", "write a word between the marks");
            i = end + 1;
        } else {
            static const std::string signs = "()+-*/,<>=!^";
            if (signs.find(c) == std::string::npos)
                fail_query(begin + 1, "'" + printable(std::string(1, c), 10) + "' has no meaning here",
                           "put words with other signs in quotation marks: \"left arm\"");
            ++i;
            if ((c == '<' || c == '>' || c == '!') && i < text.size() && text[i] == '=') ++i;
            tokens.push_back({QueryToken::Kind::sign, text.substr(begin, i - begin), 0, begin + 1});
        }
    }
    tokens.push_back({QueryToken::Kind::end, {}, 0, text.size() + 1});
    return tokens;
}

class QueryParser {
public:
    explicit QueryParser(const std::string& text) : tokens_(query_tokens(text)) {}

    NodePointer parse() {
        if (next().kind == QueryToken::Kind::end) fail_query(1, "the query is empty", "write, say, '2 arm and 2 leg'");
        NodePointer node = truth(either());
        if (next().kind != QueryToken::Kind::end)
            fail_query(next().at, "'" + printable(next().text, 30) + "' cannot stand after the text before it",
                       "join conditions by 'and' or 'or'");
        return node;
    }

private:
    [[nodiscard]] const QueryToken& next(std::size_t ahead = 0) const {
        return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
    }
    [[nodiscard]] bool is(const char* text, std::size_t ahead = 0) const {
        const QueryToken& token = next(ahead);
        return (token.kind == QueryToken::Kind::sign || token.kind == QueryToken::Kind::name) && token.text == text;
    }
    bool take(const char* text) { return is(text) && (++at_, true); }
    void expect(const char* sign, const std::string& remedy) {
        if (!take(sign)) fail_query(next().at, std::string("'") + sign + "' is missing", remedy);
    }
    static NodePointer node(NodeKind kind, std::size_t at, std::string text = {}) {
        auto made = std::make_unique<QueryNode>();
        made->kind = kind, made->at = at, made->text = std::move(text);
        return made;
    }
    static NodePointer pair(NodeKind kind, std::size_t at, NodePointer a, NodePointer b, std::string text = {}) {
        NodePointer made = node(kind, at, std::move(text));
        made->of.push_back(std::move(a));
        made->of.push_back(std::move(b));
        return made;
    }

    static bool is_truth(const QueryNode& node) {
        return node.kind <= NodeKind::count || node.kind == NodeKind::related || node.kind == NodeKind::same;
    }
    /// Converts an expression to a condition; a single word becomes "such a part exists".
    static NodePointer truth(NodePointer given) {
        if (is_truth(*given)) return given;
        if (given->kind != NodeKind::word)
            fail_query(given->at, "a condition is expected, but this is a number", "compare it, as in 'area(handle) > 5 mm^2'");
        given->kind = NodeKind::count;
        given->words = {given->text};
        given->value = 1;
        return given;
    }
    static NodePointer amount(NodePointer given) {
        if (is_truth(*given))
            fail_query(given->at, "a number is expected, but this is a condition", "join conditions by 'and' or 'or'");
        if (given->kind == NodeKind::word)
            fail_query(given->at, "a number is expected, but this is the word '" + printable(given->text, 30) + "'",
                       "write which quantity of it is compared: area(" + printable(given->text, 30) + ")");
        return given;
    }

    NodePointer either() {
        const Depth deeper(*this);
        NodePointer left = both();
        while (is("or")) {
            const std::size_t at = tokens_[at_++].at;
            left = pair(NodeKind::either, at, truth(std::move(left)), truth(both()));
        }
        return left;
    }
    NodePointer both() {
        NodePointer left = negated();
        while (is("and")) {
            const std::size_t at = tokens_[at_++].at;
            left = pair(NodeKind::both, at, truth(std::move(left)), truth(negated()));
        }
        return left;
    }
    NodePointer negated() {
        const Depth deeper(*this);
        if (!is("not")) return comparison();
        NodePointer made = node(NodeKind::none, tokens_[at_++].at);
        made->of.push_back(truth(negated()));
        return made;
    }
    NodePointer comparison() {
        NodePointer left = sum();
        for (const char* sign : {"<=", ">=", "!=", "<", ">", "="}) {
            if (!is(sign)) continue;
            const std::size_t at = tokens_[at_++].at;
            NodePointer right = sum();
            if (left->kind == NodeKind::word) std::swap(left, right), sign = turned(sign);
            if (right->kind != NodeKind::word)
                return pair(NodeKind::compare, at, amount(std::move(left)), amount(std::move(right)), sign);
            if (left->kind != NodeKind::quantity || (std::string_view(sign) != "=" && std::string_view(sign) != "!="))
                fail_query(
                    at, "words can be compared with attributes only, by = or !=", "write, say, 'decoration(body) = \"painted\"'");
            return pair(NodeKind::compare, at, std::move(left), std::move(right), sign);
        }
        return left;
    }
    static const char* turned(std::string_view sign) {
        return sign == "<=" ? ">=" : sign == ">=" ? "<=" : sign == "<" ? ">" : sign == ">" ? "<" : sign == "=" ? "=" : "!=";
    }
    NodePointer sum() {
        NodePointer left = product();
        while (is("+") || is("-")) {
            const QueryToken& sign = tokens_[at_++];
            left =
                pair(sign.text == "+" ? NodeKind::add : NodeKind::subtract, sign.at, amount(std::move(left)), amount(product()));
        }
        return left;
    }
    NodePointer product() {
        NodePointer left = primary();
        while (is("*") || is("/")) {
            const QueryToken& sign = tokens_[at_++];
            left = pair(sign.text == "*" ? NodeKind::multiply : NodeKind::divide, sign.at, amount(std::move(left)),
                        amount(primary()));
        }
        return left;
    }
    NodePointer primary() {
        const Depth deeper(*this);
        const QueryToken token = next();
        if (take("(")) {
            NodePointer inner = either();
            expect(")", "close the bracket of column " + std::to_string(token.at));
            return inner;
        }
        if (take("-")) return pair(NodeKind::subtract, token.at, node(NodeKind::number, token.at), amount(primary()));
        if (token.kind == QueryToken::Kind::number) return number();
        if ((token.kind == QueryToken::Kind::name || token.kind == QueryToken::Kind::quoted) && !keyword(token)) {
            ++at_;
            if (is("(")) return call(token);
            return node(NodeKind::word, token.at, token.text);
        }
        fail_query(token.at,
                   token.kind == QueryToken::Kind::end
                       ? "the query is incomplete"
                       : "'" + printable(token.text, 30) + "' stands where a word or a number is expected",
                   "write a part ('handle'), a number, or a quantity such as area(handle)");
    }
    static bool keyword(const QueryToken& token) {
        return token.kind == QueryToken::Kind::name && (token.text == "and" || token.text == "or" || token.text == "not");
    }

    /// A number with an optional unit, or a count of parts: "2 arm".
    NodePointer number() {
        const QueryToken token = tokens_[at_++];
        NodePointer made = node(NodeKind::number, token.at);
        made->value = token.value;
        const QueryToken& word = next();
        if ((word.kind != QueryToken::Kind::name && word.kind != QueryToken::Kind::quoted) || keyword(word)) return made;
        std::string unit = word.text;
        if (word.kind == QueryToken::Kind::name && is("^", 1) && next(2).kind == QueryToken::Kind::number)
            unit += "^" + next(2).text;
        if (word.kind == QueryToken::Kind::name && query_unit(unit)) {
            at_ += unit == word.text ? 1 : 3;
            made->unit = unit;
            return made;
        }
        if (is("^", 1))
            fail_query(word.at, "'" + printable(unit, 20) + "' is not a known unit",
                       "use mm, cm, m, in, their powers, deg or rad");
        if (std::floor(token.value) != token.value || token.value < 1)
            fail_query(token.at, "there are no " + printable(token.text, 20) + " parts",
                       "give a whole number from 1, or a unit such as mm");
        made->kind = NodeKind::count;
        made->words = {word.text};
        ++at_;
        return made;
    }

    NodePointer call(const QueryToken& name) {
        expect("(", "");
        std::vector<std::string> words;
        do {
            const QueryToken& token = next();
            if (token.kind == QueryToken::Kind::end || token.kind == QueryToken::Kind::sign)
                fail_query(token.at, "a word is missing in the brackets of '" + printable(name.text, 30) + "'",
                           "name a part: " + printable(name.text, 30) + "(handle)");
            words.push_back(token.text);
            ++at_;
        } while (take(","));
        expect(")", "put names of several words in quotation marks, and close the bracket");
        const bool plain = name.kind == QueryToken::Kind::name;
        NodePointer made = node(NodeKind::quantity, name.at, name.text);
        std::size_t least = 1, most = 1;
        if (plain && name.text == "has") made->kind = NodeKind::count, made->value = 1;
        else if (plain && name.text == "count") made->kind = NodeKind::number_of;
        else if (plain && name.text == "related") made->kind = NodeKind::related, least = 2, most = 3;
        else if (plain && name.text == "same") made->kind = NodeKind::same, least = most = 2;
        if (words.size() < least || words.size() > most)
            fail_query(name.at,
                       "'" + printable(name.text, 30) + "' takes " + (least == most ? std::to_string(least) : "2 or 3") +
                           " words, and " + std::to_string(words.size()) + (words.size() == 1 ? " is" : " are") + " given",
                       "see doc/annotation-find.md");
        if (least > 1) {
            made->text = words.front();
            words.erase(words.begin());
        }
        made->words = std::move(words);
        return made;
    }

    struct Depth {
        explicit Depth(QueryParser& owner) : parser(owner) {
            if (++parser.depth_ > 400) fail_query(parser.next().at, "brackets are nested too deeply", "make it simpler");
        }
        ~Depth() { --parser.depth_; }
        Depth(const Depth&) = delete;
        Depth& operator=(const Depth&) = delete;
        QueryParser& parser;
    };

    std::vector<QueryToken> tokens_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

}  // namespace

std::optional<QueryUnit> query_unit(const std::string& unit) {
    static constexpr std::pair<const char*, int> bases[]{{"m", 1},    {"m^2", 2},    {"m^3", 3},
                                                         {"1/m", -1}, {"1/m^2", -2}, {"rad", 0}};
    if (unit == "%") return QueryUnit{0, 0.01};
    for (const auto& [base, power] : bases)
        if (const auto factor = converted(1, unit, base)) return QueryUnit{power, *factor};
    return std::nullopt;
}

std::unique_ptr<AnnotationQuery::Node> parse_query(const std::string& text) {
    if (text.size() > 10000) fail_usage("the query is " + std::to_string(text.size()) + " bytes long", "at most 10000 are read");
    return QueryParser(text).parse();
}

}  // namespace ostraka::detail
