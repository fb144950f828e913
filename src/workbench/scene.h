// What the page shows of a session: the content of a page (page/page.h) with exact shapes.
#pragma once

#include "ostraka/page/page.h"
#include "ostraka/workbench/session.h"

#include <set>

namespace ostraka::workbench {

struct ShownShape {
    std::string name, key;  ///< the key says which shape it is: what has been sent once is not sent again
    const Mesh* mesh = nullptr;
    const AnnotationSet* set = nullptr;
    const RelationGraph* graph = nullptr;
    const Mesh* cage = nullptr;
    /// Files of the session that say something of it: maps, slices, the report of its deformation.
    std::vector<Path> files;
    std::vector<PageMap> maps;  ///< that the mesh's own file holds
};

/// The files of the active object's last steps that can be shown with it.
std::vector<Path> files_for(const Session& session, bool deformed);

class Scene {
public:
    explicit Scene(const std::vector<std::string>& known) : known_(known.begin(), known.end()) {}
    void add(const ShownShape& shape);
    /// The tables of a step's report.
    void add_report(const Path& file, const std::string& operation);
    [[nodiscard]] Page::Content content(const std::string& made_how) const { return page_.content(made_how); }

private:
    std::set<std::string> known_;
    Page page_{"Ostraka"};
};

}  // namespace ostraka::workbench
