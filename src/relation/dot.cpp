// Graphviz DOT.
#include "ostraka/relation/graph.h"

#include "ostraka/core/text.h"

#include <cstdio>

namespace ostraka {

namespace {

/// Quotes text for DOT, which interprets \" and its own escapes after a backslash, and decodes HTML entities.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : without_controls(text, " ")) {
        if (c == '"') out += "&quot;";
        else if (c == '\\') out += "&#92;";
        else if (c == '&') out += "&amp;";
        else if (c == '<') out += "&lt;";
        else if (c == '>') out += "&gt;";
        else out += c;
    }
    return out + '"';
}

std::string label_of(const Relationship& relationship) {
    std::string label = relationship.type;
    if (!relationship.parameters.attribute.empty()) label += ": " + relationship.parameters.attribute;
    if (relationship.is_constraint) label += " (weight " + digits(relationship.weight, 4) + ")";
    return label;
}

}  // namespace

std::string graph_to_dot(const RelationGraph& graph, const AnnotationSet& set) {
    const auto node = [](int id) { return "\"a" + std::to_string(id) + "\""; };
    std::string text =
        "digraph relationships {\n  node [style=filled, fontname=\"sans-serif\"];\n"
        "  edge [fontname=\"sans-serif\", fontsize=10];\n";
    for (const auto& annotation : set.annotations) {
        char colour[16];
        const auto& [red, green, blue] = annotation.colour;
        std::snprintf(colour, sizeof colour, "#%02x%02x%02x", red & 255, green & 255, blue & 255);
        const bool dark = 299 * red + 587 * green + 114 * blue < 128000;
        const char* shape = annotation.type == AnnotationType::region ? "box"
                            : annotation.type == AnnotationType::line ? "ellipse"
                                                                      : "circle";
        text += "  " + node(annotation.id) + " [label=" + quoted(annotation.tag) + ", shape=" + shape + ", fillcolor=\"" +
                colour + "\", fontcolor=" + (dark ? "white" : "black") + "];\n";
    }
    for (const auto& relationship : graph.relationships) {
        const std::string label = quoted(label_of(relationship)), style = relationship.is_constraint ? ", style=bold" : "";
        const std::string plain = relationship.directed ? "" : ", dir=none";
        const auto& members = relationship.annotations;
        if (members.size() == 2) {
            const bool tree = relationship.type == relation_type(GeometricRelation::containment).name;
            text += "  " + node(members[0]) + " -> " + node(members[1]) + " [label=" + label + plain + style +
                    (tree ? "" : ", constraint=false") + "];\n";
            continue;
        }
        const std::string hub = "\"r" + std::to_string(relationship.id) + "\"";
        text += "  " + hub + " [label=" + label + ", shape=diamond, fillcolor=white, fontsize=10" +
                (relationship.is_constraint ? ", penwidth=2" : "") + "];\n";
        for (std::size_t i = 0; i < members.size(); ++i)
            text += i == 0 && relationship.directed ? "  " + node(members[i]) + " -> " + hub + ";\n"
                                                    : "  " + hub + " -> " + node(members[i]) + " [" +
                                                          (relationship.directed ? "dir=forward" : "dir=none") + "];\n";
    }
    return text + "}\n";
}

}  // namespace ostraka
