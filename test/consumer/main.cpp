// Makes an object at two resolutions, annotates one, carries the annotations to the other and looks at what arrives.
#include <ostraka/annotation/label_file.h>
#include <ostraka/core/error.h>
#include <ostraka/measure/examine.h>
#include <ostraka/synthetic/make_mesh.h>
#include <ostraka/transfer/transfer.h>

#include <algorithm>
#include <iostream>

int main() try {
    using namespace ostraka;
    const SyntheticObject& object = synthetic_object("sphere");
    const SyntheticMesh source = make_mesh(object, {.vertices = 2000});
    const SyntheticMesh target = make_mesh(object, {.vertices = 4000, .seed = 2});
    const AnnotationSet annotations = regions_from_labels(source.mesh, source.face_labels);

    const TransferResult result = transfer({source.mesh, annotations}, SurfaceSearch(target.mesh));
    for (const TransferScore& score : result.scores)
        std::cout << score.tag << ": " << to_string(score.outcome) << ", area " << score.source_area << " -> "
                  << score.target_area << '\n';

    const std::vector<Finding> findings = examine({target.mesh, result.annotations});
    const bool sound = std::none_of(findings.begin(), findings.end(), [](const Finding& finding) { return finding.defect; });
    const bool kept = std::all_of(result.scores.begin(), result.scores.end(),
                                  [](const TransferScore& score) { return score.outcome == ostraka::TransferOutcome::kept; });
    return sound && kept && result.scores.size() == object.parts.size() ? 0 : 1;
} catch (const ostraka::Error& error) {
    std::cerr << error.what() << '\n';
    return 2;
}
