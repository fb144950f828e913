// Annotation sets that formats must represent completely, and the comparison of sets.
#pragma once

#include "annotation/example_meshes.h"
#include "ostraka/annotation/annotation_file.h"

#include <gtest/gtest.h>

namespace ostraka::example {

/// Texts that other formats could interpret as markup, scripts, formulas, separators or line ends.
inline std::vector<std::string> wild_texts() {
    return {"plain",
            "with \"quotes\" and 'others'",
            "a, b; c\td",
            "two\nlines\r\nand three",
            "</script><script>alert(1)</script>",
            "<b>&amp; & ]]> --></b>",
            "=1+1",
            "+SUM(A1)",
            "-2+3",
            "@cmd|' /C calc'!A0",
            "'=quoted",
            "''-twice",
            "\t=tab",
            "\n=line",
            "  =blank",
            "\xEF\xBC\x9D"
            "wide",
            std::string("control \x01\x02\x1B and nul \0 end", 26),
            "naïve Ὄστρακον 陶片 🏺",
            "# comment",
            "a;=1+1",
            "a\t @SUM(A1)",
            "\xC2\xA0=1",
            "b \xE3\x80\x80+1",
            "\xE2\x80\x8B-1",
            "\xEF\xBB\xBF=1",
            "c\xE2\x80\xA8=1",
            "\xC2\x85@x",
            "\xEF\xB9\xA3"
            "1",
            "'\xE2\x88\x92"
            "1",
            "\xC2\x9B"
            "31m and \xE2\x80\xAE turned \xE2\x81\xA6 around",
            "-5",
            " edges ",
            "back\\slash \\u003C",
            "\xE2\x80\xA8 separators \xE2\x80\xA9",
            "LM3=2",
            ""};
}

inline Attribute semantic(int id, const std::string& name, const std::string& note) {
    Attribute attribute;
    attribute.id = id;
    attribute.name = name;
    attribute.value = Note{note, {}};
    return attribute;
}

/// Points, lines, overlapping regions, the whole; every kind of attribute; difficult texts everywhere. Requires `spheres(3)` or
/// a mesh with as many faces.
inline AnnotationSet wild_set(const Mesh& mesh) {
    AnnotationSet set;
    set.object_class = "class \"of\" <things>";
    set.unit = "mm";
    set.up = {0, 0, 1};
    const auto texts = wild_texts();
    const auto add = [&](AnnotationType type, int id, const std::string& tag) -> Annotation& {
        Annotation annotation;
        annotation.id = id;
        annotation.tag = tag;
        annotation.type = type;
        annotation.colour = {id * 37 % 256, id * 91 % 256, id * 53 % 256};
        return set.annotations.emplace_back(std::move(annotation));
    };
    int id = 3;
    for (std::size_t i = 0; i < texts.size(); ++i, id += 2) {
        Annotation& point = add(AnnotationType::point, id, texts[i]);
        point.points = {static_cast<Index>(5 * i + 1)};
        point.attributes.push_back(semantic(1, texts[(i + 1) % texts.size()], texts[(i + 2) % texts.size()]));
    }
    add(AnnotationType::point, id++, "several").points = {7, 3, 11};
    Annotation& line = add(AnnotationType::line, id++, "way, with a comma");
    // Straight across faces.
    Halfedge h = mesh.halfedge(Vertex(0));
    std::vector<Index> way{mesh.source(h)};
    for (int k = 0; k < 6; ++k, h = mesh.next(mesh.opposite(mesh.next(h)))) way.push_back(mesh.target(h));
    line.polylines = {way};
    const auto [a, b, c] = corners(mesh, Face(9));
    line.polylines.push_back({a, b, c, a});
    Annotation& lower = add(AnnotationType::region, id++, "half <low>");
    Annotation& upper = add(AnnotationType::region, id++, "cap & more");
    Annotation& two = add(AnnotationType::region, id++, "two patches");
    for (const Face f : mesh.faces()) {
        const Point p = centroid(mesh, f);
        if (p.z() < 0.3) lower.faces.push_back(f);
        if (p.z() > 0) upper.faces.push_back(f);
        if (std::abs(p.x()) > 0.8) two.faces.push_back(f);
    }
    Attribute measure;
    measure.id = 4;
    measure.name = "height, \"max\"";
    measure.value = Measure{"bounding",
                            {4, 5},
                            {face_point(0, {0.25, 0.5, 0.25}), face_point(1, {1, 0, 0})},
                            std::array<double, 3>{0, -0.6, 0.8},
                            1.0 / 3,
                            "mm",
                            true};
    upper.attributes.push_back(measure);
    measure.id = 5;
    measure.name = "=way";
    measure.value = Measure{"tape", {1, 2, 3}, {}, {}, {}, "", false};
    measure.measure()->repeats = {{2, 2, 3}, {1, 7, 3}};
    measure.measure()->uncertainty = 0.25;
    measure.measure()->exact = true;
    upper.attributes.push_back(measure);
    Attribute inferred = semantic(9, "size", "small");
    inferred.note()->origin = "rule \"small\": height < 1, of <this>";
    upper.attributes.push_back(inferred);
    Attribute descriptor;
    descriptor.id = 6;
    descriptor.name = "area";
    descriptor.value = Descriptor{{-1e-300}, false, "", "mm^2", true};
    upper.attributes.push_back(descriptor);
    descriptor.id = 7;
    descriptor.value = Descriptor{{1, 2.5, -3}, true, "", "", false};
    upper.attributes.push_back(descriptor);
    descriptor.id = 8;
    descriptor.value = Descriptor{{}, false, "curvature map.npy", "1/mm", false};
    upper.attributes.push_back(descriptor);
    upper.note = "shrank; \"see\" <report>";
    Annotation whole;
    whole.id = 0;
    whole.tag = "thing";
    whole.all = true;
    for (const Face f : mesh.faces()) whole.faces.push_back(f);
    set.annotations.insert(set.annotations.begin(), whole);
    return set;
}

inline AnnotationSet copy_of(const AnnotationSet& set) {
    AnnotationSet copy;
    copy.object_class = set.object_class;
    copy.unit = set.unit;
    copy.up = set.up;
    copy.annotations = set.annotations;
    return copy;
}

/// Text of the set's file; sets are equal if their texts are.
inline std::string as_file(const AnnotationSet& set, const Mesh& mesh) {
    return to_text(annotations_to_json({mesh, set}, "m.ply", {}));
}

/// Checks that `whole` does not contain `part` outside of quoted data.
inline std::size_t occurrences(const std::string& text, const std::string& searched) {
    std::size_t count = 0;
    for (std::size_t position = text.find(searched); position != std::string::npos; position = text.find(searched, position + 1))
        ++count;
    return count;
}

}  // namespace ostraka::example
