// An independent check that synthetic meshes have no self-intersections.
#include "ostraka/synthetic/make_mesh.h"

#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <gtest/gtest.h>

using namespace ostraka;

TEST(MakeMesh, NoTriangleCrossesAnother) {
    for (const std::string& name : synthetic_object_names()) {
        for (const std::uint64_t vertices : {synthetic_object(name).minimum_vertices, std::size_t{6000}}) {
            MakeOptions options;
            options.vertices = vertices;
            options.noise = vertices == 6000 ? 0.1 : 0;
            EXPECT_FALSE(CGAL::Polygon_mesh_processing::does_self_intersect(make_mesh(synthetic_object(name), options).mesh))
                << name << vertices;
        }
    }
}
