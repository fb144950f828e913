// Performs one task with CGAL's own functions, with OpenMesh or with this library, one task per process, and prints its cost
// and result.
//     ostraka_peers TASK PEER ARGUMENTS...
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/mesh/mesh.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_halfedge_graph_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/Surface_mesh_deformation.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#define _USE_MATH_DEFINES
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace ostraka;
using Words = std::vector<std::string>;
using OpenMeshMesh = OpenMesh::TriMesh_ArrayKernelT<>;
namespace PMP = CGAL::Polygon_mesh_processing;
namespace SMS = CGAL::Surface_mesh_simplification;

/// Seconds since the last call.
double lap() {
    using Clock = std::chrono::steady_clock;
    static Clock::time_point last = Clock::now();
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last).count();
    last = now;
    return seconds;
}

Mesh read_by_cgal(const std::string& file) {
    Mesh mesh;
    std::ifstream in(file, std::ios::binary);
    if (!CGAL::IO::read_PLY(in, mesh)) throw std::runtime_error(file + " cannot be read by CGAL");
    return mesh;
}

void write_by_cgal(const std::string& file, const Mesh& mesh) {
    std::ofstream out(file, std::ios::binary);
    CGAL::IO::set_binary_mode(out);
    CGAL::IO::write_PLY(out, mesh);
}

OpenMeshMesh read_by_openmesh(const std::string& file) {
    OpenMeshMesh mesh;
    if (!OpenMesh::IO::read_mesh(mesh, file)) throw std::runtime_error(file + " cannot be read by OpenMesh");
    return mesh;
}

/// Reads and writes a mesh; "work" covers both.
void convert_by_cgal(const Words& words) {
    write_by_cgal(words.at(1), read_by_cgal(words.at(0)));
    std::printf("{\"work\": %.4f}\n", lap());
}
void convert_by_openmesh(const Words& words) {
    OpenMesh::IO::write_mesh(read_by_openmesh(words.at(0)), words.at(1), OpenMesh::IO::Options::Binary);
    std::printf("{\"work\": %.4f}\n", lap());
}

void slice_by_cgal(const Words& words) {
    const Mesh mesh = read_by_cgal(words.at(0));
    const double count = std::stod(words.at(1)), read = lap();
    const CGAL::Polygon_mesh_slicer<Mesh, Kernel> slicer(mesh);
    const CGAL::Bbox_3 box = PMP::bbox(mesh);
    double length = 0;
    for (double i = 0.5; i < count; ++i) {
        std::vector<std::vector<Point>> lines;
        slicer(Kernel::Plane_3(0, 0, 1, -(box.zmin() + (box.zmax() - box.zmin()) * i / count)), std::back_inserter(lines));
        for (const auto& line : lines)
            for (std::size_t k = 1; k < line.size(); ++k) length += std::sqrt(CGAL::squared_distance(line[k - 1], line[k]));
    }
    std::printf("{\"read\": %.4f, \"work\": %.4f, \"length\": %.9g}\n", read, lap(), length);
}

void simplify_by_cgal(const Words& words) {
    Mesh mesh = read_by_cgal(words.at(0));
    const double read = lap();
    const auto edges = 3 * std::stoul(words.at(2));
    using Quadrics = SMS::GarlandHeckbert_plane_policies<Mesh, Kernel>;
    const Quadrics quadrics(mesh);
    SMS::edge_collapse(mesh, SMS::Count_stop_predicate<Mesh>(edges),
                       CGAL::parameters::get_cost(quadrics.get_cost()).get_placement(quadrics.get_placement()));
    const double work = lap();
    mesh.collect_garbage();
    write_by_cgal(words.at(1), mesh);
    std::printf("{\"read\": %.4f, \"work\": %.4f}\n", read, work);
}

void simplify_by_openmesh(const Words& words) {
    OpenMeshMesh mesh = read_by_openmesh(words.at(0));
    const double read = lap();
    OpenMesh::Decimater::DecimaterT<OpenMeshMesh> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<OpenMeshMesh>::Handle quadric;
    decimater.add(quadric);
    decimater.module(quadric).unset_max_err();
    decimater.initialize();
    decimater.decimate_to(std::stoul(words.at(2)));
    mesh.garbage_collection();
    const double work = lap();
    OpenMesh::IO::write_mesh(mesh, words.at(1), OpenMesh::IO::Options::Binary);
    std::printf("{\"read\": %.4f, \"work\": %.4f}\n", read, work);
}

void print_distances(double read, double build, double work, const std::vector<double>& distances) {
    double sum = 0, maximum = 0;
    for (const double d : distances) sum += d, maximum = std::max(maximum, d);
    std::printf("{\"read\": %.4f, \"build\": %.4f, \"work\": %.4f, \"mean\": %.9g, \"maximum\": %.9g}\n", read, build, work,
                sum / static_cast<double>(distances.size()), maximum);
}

/// Closest points on the first mesh to the vertices of the second: builds the tree, then queries it.
void closest_by_cgal(const Words& words) {
    const Mesh mesh = read_by_cgal(words.at(0)), other = read_by_cgal(words.at(1));
    const double read = lap();
    using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(faces(mesh).begin(), faces(mesh).end(), mesh);
    tree.build();
    tree.accelerate_distance_queries();
    const double build = lap();
    std::vector<double> distances(other.number_of_vertices());
    for (const Vertex v : other.vertices()) distances[v] = std::sqrt(tree.squared_distance(other.point(v)));
    print_distances(read, build, lap(), distances);
}

void closest_by_us(const Words& words) {
    const Mesh mesh = read_mesh(words.at(0)).mesh, other = read_mesh(words.at(1)).mesh;
    const double read = lap();
    const SurfaceSearch search(mesh);
    const double build = lap();
    std::vector<double> distances(other.number_of_vertices());
    parallel_for(distances.size(), 64,
                 [&](std::size_t i) { distances[i] = search.closest(other.point(Vertex(static_cast<Index>(i)))).distance; });
    print_distances(read, build, lap(), distances);
}

/// One-sided Hausdorff distance from the first surface to the second, within 0.1 % of the diagonal.
void hausdorff_by_cgal(const Words& words) {
    const Mesh a = read_by_cgal(words.at(0)), b = read_by_cgal(words.at(1));
    const double read = lap(), bound = 0.001 * box_diagonal(a);
    const double distance = PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(a, b, bound);
    std::printf("{\"read\": %.4f, \"work\": %.4f, \"maximum\": %.9g}\n", read, lap(), distance);
}

/// ARAP deformation: the highest 15 % are raised by a tenth of the height, the lowest tenth is fixed; ten iterations.
void raise_by_cgal(const Words& words) {
    Mesh mesh = read_by_cgal(words.at(0));
    const double read = lap();
    const CGAL::Bbox_3 box = PMP::bbox(mesh);
    const double height = box.zmax() - box.zmin();
    CGAL::Surface_mesh_deformation<Mesh> deformation(mesh);
    deformation.insert_roi_vertices(vertices(mesh).begin(), vertices(mesh).end());
    std::vector<Vertex> moved;
    for (const Vertex v : mesh.vertices()) {
        const double t = (mesh.point(v).z() - box.zmin()) / height;
        if (t >= 0.85 || t <= 0.1) deformation.insert_control_vertex(v);
        if (t >= 0.85) moved.push_back(v);
    }
    deformation.preprocess();
    const double build = lap();
    deformation.translate(moved.begin(), moved.end(), Vector(0, 0, 0.1 * height));
    deformation.deform(10, 0.0);
    const double work = lap();
    write_by_cgal(words.at(1), mesh);
    std::printf("{\"read\": %.4f, \"build\": %.4f, \"work\": %.4f}\n", read, build, work);
}

}  // namespace

int main(int argc, char** argv) {
    const std::map<std::string, std::function<void(const Words&)>> tasks{
        {"convert cgal", convert_by_cgal},   {"convert openmesh", convert_by_openmesh},   {"slice cgal", slice_by_cgal},
        {"simplify cgal", simplify_by_cgal}, {"simplify openmesh", simplify_by_openmesh}, {"closest cgal", closest_by_cgal},
        {"closest ours", closest_by_us},     {"hausdorff cgal", hausdorff_by_cgal},       {"raise cgal", raise_by_cgal}};
    const auto task = argc < 3 ? tasks.end() : tasks.find(std::string(argv[1]) + ' ' + argv[2]);
    if (task == tasks.end()) {
        std::fprintf(stderr, "usage: ostraka_peers TASK PEER ARGUMENTS...   with one of:\n");
        for (const auto& [name, run] : tasks) std::fprintf(stderr, "  %s\n", name.c_str());
        return 2;
    }
    try {
        lap();
        task->second(Words(argv + 3, argv + argc));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "ostraka_peers: %s\n", error.what());
        return 1;
    }
}
