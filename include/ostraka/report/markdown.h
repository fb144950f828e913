// Texts from outside within Markdown: whatever they hold, they stay text, also where the Markdown becomes HTML.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// One line: what breaks lines or steers becomes a blank, and marks of Markdown and HTML are escaped.
std::string markdown_text(std::string_view text);

/// As `markdown_text` for each line; an empty line begins a paragraph, and no line begins a list, a rule or a heading.
std::string markdown_paragraphs(std::string_view text);

/// The name of a file below the page, as the address of a link or a picture.
std::string markdown_file(std::string_view name);

}  // namespace ostraka
