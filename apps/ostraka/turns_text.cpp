#include "turns_text.h"

#include "command.h"

namespace ostraka::app {

std::string turns_text(const BreakTurns& turns, const std::vector<std::string>& names) {
    std::string text;
    std::vector<std::vector<std::string>> rows;
    for (const BreakJoint& joint : turns.joints)
        rows.push_back({printable(names[static_cast<std::size_t>(joint.first)]) + " - " +
                            printable(names[static_cast<std::size_t>(joint.second)]),
                        number(joint.turn, 4), number(100 * joint.contact, 3), number(100 * joint.rim, 3),
                        number(joint.residual, 3), joint.carries ? number(joint.confidence, 2) : "-",
                        !joint.carries  ? "closes a cycle"
                        : joint.decided ? "decided"
                                        : "not decided"});
    if (!rows.empty()) text += table({"breaks", "turn, degrees", "contact %", "rim %", "residual", "confidence", ""}, rows);
    for (std::size_t k = 0; k < names.size() && k < turns.notes.size(); ++k)
        if (!turns.notes[k].empty()) text += printable(names[k]) + ": " + printable(turns.notes[k]) + '\n';
    return text;
}

}  // namespace ostraka::app
