// A mesh file together with what is bound to it, while its resolution changes.
#pragma once

#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/annotation_maps.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/simplify.h"

#include <optional>

namespace ostraka::app {

struct BoundMeshFiles {
    std::string input, output;
    std::string annotations, annotations_out;
    std::string labels_out, vertex_map, face_map;
    bool ascii = false;
    ReadAnnotationsOptions reading;
};

/// The mesh with its colours, labels and annotations in property maps.
class BoundMesh {
public:
    /// Checks the names of all files, then reads.
    BoundMesh(const BoundMeshFiles& files, Provenance& provenance);

    Mesh mesh;

    /// Outlines of regions, poly-lines and points; with `pins`, the pins of measures too.
    [[nodiscard]] MarkedParts marked(bool pins) const;
    /// Keeps the map of edges that carry poly-lines true when edges merge.
    [[nodiscard]] CollapseVisitor* visitor() { return visitor_.get(); }

    void follow(const SimplifyResult& result);
    void follow(const RefineResult& result);
    /// Writes everything that was asked for; returns notes.
    std::vector<std::string> write(const Provenance& provenance);

    /// Counts and areas before and after, per annotation what became of it.
    void add_to_report(JsonValue& result, JsonAllocator& allocator) const;
    [[nodiscard]] std::string tables() const;

private:
    struct Measures {
        std::size_t elements = 0;
        double area = 0, length = 0;  ///< length: perimeter of a region, length of a line
        bool degenerate = false;      ///< the region has no faces left
    };
    struct Row {
        int id = 0;
        std::string tag, type;
        Measures before, after;
        std::string note;
    };
    struct Totals {
        std::size_t vertices = 0, faces = 0;
        double area = 0;
    };
    [[nodiscard]] static Totals totals(const Mesh& mesh);
    [[nodiscard]] Measures measure(const Annotation& annotation) const;
    void collect(const std::vector<Index>& vertex_map);

    const BoundMeshFiles& files_;
    std::vector<std::string> notes_;
    std::optional<AnnotationSet> before_, after_;
    AnnotationTable table_;
    std::unique_ptr<CollapseVisitor> visitor_;
    std::vector<Row> rows_;
    Totals totals_before_, totals_after_;
    std::vector<Index> vertex_map_, face_map_;
};

/// The flags that simplify and refine share.
void add_bound_mesh_flags(CLI::App* command, BoundMeshFiles& files);

}  // namespace ostraka::app
