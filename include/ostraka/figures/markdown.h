// Escapes untrusted text in Markdown, so that the text cannot act as markup, also when the Markdown is converted to HTML.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// The text as a single line: line breaks and control characters become blanks, and Markdown and HTML markup is escaped.
std::string markdown_text(std::string_view text);

/// Escapes each line of the text as `markdown_text` does. An empty line starts a paragraph, and no line starts a list, a rule or
/// a heading.
std::string markdown_paragraphs(std::string_view text);

/// A relative file name, escaped for use as the address of a link or a picture.
std::string markdown_file(std::string_view name);

}  // namespace ostraka
