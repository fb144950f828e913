// Escaping of untrusted text in Markdown: it stays text, also where the Markdown becomes HTML.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// A single line: line breaks and control characters become blanks, and Markdown and HTML markup is escaped.
std::string markdown_text(std::string_view text);

/// Like `markdown_text` for each line; an empty line starts a paragraph, and no line starts a list, a rule or a heading.
std::string markdown_paragraphs(std::string_view text);

/// The name of a file below the page, escaped for use as the address of a link or a picture.
std::string markdown_file(std::string_view name);

}  // namespace ostraka
