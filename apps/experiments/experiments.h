#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/mesh.h"
#include "ostraka/reassembly/reassembly.h"
#include "ostraka/registration/pose_search.h"
#include "ostraka/stats/boosted_trees.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka::experiments {

struct TableOptions {
    std::vector<std::string> made{"teapot", "statuette", "hand"};
    std::vector<std::string> scans;
    std::size_t full = 2000000;
    std::vector<std::size_t> rungs{50000, 5000, 100000, 1000000};
    std::string metric;
    std::string csv;
    bool no_independent = false, truth_only = false;
};
void transfer_table(const TableOptions& options);

/// Transfers free outlines to other resolutions and meshes and back, and compares them with pointwise projections of the
/// curves.
struct FreeOutlineOptions {
    std::vector<std::string> objects{"made:teapot", "made:statuette", "made:hand"};  ///< made:NAME or mesh files
    std::vector<std::size_t> sizes{5000, 50000, 100000, 1000000};                    ///< ascending
    std::vector<double> shares{0.005, 0.025, 0.1};
    int discs = 3;
    std::string csv;
};
void free_outlines(const FreeOutlineOptions& options);

/// Table 4.1: time and memory of flattening a region, over the mesh and through a cage.
struct Table41Options {
    std::string made = "teapot", scan, output = "experiments-output/table-4-1";
    std::vector<std::uint64_t> sizes{20000, 50000, 70000, 100000, 150000, 200000, 280000, 500000};
    std::vector<double> direction{0, -1, 0};  ///< the region surrounds the vertex that is farthest in this direction
    double share = 0.025;                     ///< area share of the region
    std::uint64_t cage_vertices = 200;
    int iterations = 50;
    int convergence = 0;  ///< number of iterations for comparing plain and accelerated runs; 0: no comparison
};
void table_4_1(const Table41Options& options);

/// Figure 4.6: a region is flattened; displacements of the other vertices.
struct Figure46Options {
    std::string mesh, annotations, cage, region, output = "experiments-output/figure-4-6";
    std::vector<std::string> kinds{"mean-value"};
    int nodes = 20000;
};
void figure_4_6(const Figure46Options& options);

/// Figure 5.11: control points of annotations, level by level.
struct ControlPointOptions {
    std::string mesh, annotations, cage, weights, output = "experiments-output/figures-5-11-5-12";
    double threshold = 0.4;
};
void control_points(const ControlPointOptions& options);

/// Displacement of each annotation between shapes.
struct MovedOptions {
    std::string mesh, annotations, output;
    std::string fit;       ///< folder of a fit of a fragment of `mesh`, instead of shapes
    std::string pose;      ///< from 'ostraka mesh break --pose-out', if the fragment is not in the frame of `mesh`
    std::string fragment;  ///< mesh file of the fragment, for the picture of its fitted position
    std::vector<std::string> shapes;
};
void moved(const MovedOptions& options);

/// Figure 3.7: point clusters of several forms, and the clusters found by DBSCAN.
struct ClusterPictureOptions {
    std::string output;  ///< folder
};
void cluster_picture(const ClusterPictureOptions& options);

/// Figures 6.1 and 6.2: edits and constraints through cages.
struct CageReachOptions {
    std::string mesh, annotations, graph, output = "experiments-output/figures-6-1-6-2";
    std::vector<std::string> edits, cages;  ///< files
    int iterations = 100;
};
void cage_reach(const CageReachOptions& options);

struct LabelOptions {
    std::string models, labels, csv;
    std::size_t limit = 0;
};
void label_transfer(const LabelOptions& options);

struct CageTableOptions {
    std::vector<std::string> meshes;
    std::vector<std::uint64_t> vertices{100, 200, 500};
    std::string csv;
};
void cages(const CageTableOptions& options);

/// Combinations of defects introduced into closed meshes, and the number that repair removes.
struct RepairExperiment {
    std::vector<std::string> meshes;
    int combinations = 20;  ///< per mesh
    std::uint64_t seed = 1;
    std::string csv;
};
void repairs(const RepairExperiment& options);

/// Options of the experiments on semantic constraints.
struct SemanticOptions {
    std::string output;          ///< folder
    std::string data;            ///< folder of the recipes of synthetic objects
    std::string mesh, recipe;    ///< files of the face
    std::uint64_t vertices = 0;  ///< 0: as in the thesis
    int convergence = 0;         ///< number of iterations for comparing plain and accelerated runs; 0: no comparison
};
void same_level(const SemanticOptions& options);
void structural_continuity(const SemanticOptions& options);
void face_proportions(const SemanticOptions& options);
void before_and_after(const SemanticOptions& options);

/// Classification of the technique of synthetic statuettes, by level and by simulated scanner effects.
struct TechniqueExperiment {
    std::string output;  ///< folder
    int objects = 100, seeds = 2;
    std::uint64_t vertices = 5000;
    bool variants = false;
};
void technique(const TechniqueExperiment& options);

/// The faces nearest to a seed vertex (by edge paths), up to a share of the mesh's area.
std::vector<Index> disc(const Mesh& mesh, Vertex seed, double share);

/// Planted proportions in many synthetic populations: detections and false detections.
struct FixedProportionsOptions {
    std::string output = "experiments-output/proportions";
    int seeds = 100;
};
void fixed_proportions(const FixedProportionsOptions& options);

/// Fits fragments of deformed copies of a synthetic template: errors of pose, observed and missing part, constraints.
struct FragmentExperiment {
    std::string output = "experiments-output/fragments";
    std::vector<double> shares{0.1, 0.25, 0.5};
    int seeds = 4;
    std::uint64_t vertices = 12000, seed = 1;
    int pairs = 200;
    std::string space = "mesh";  ///< space of the fit: mesh, cage or both
};
void fragments(const FragmentExperiment& options);
/// Pairs of fragments of one object, of two sizes, or of another canon: verdicts on their compatibility, and the objections.
void verdicts(const FragmentExperiment& options);

/// Compares similarities and choices of epsilon for grouping synthetic heads, and mixes of scanned faces, by mould.
struct MouldExperimentOptions {
    std::string output = "experiments-output/moulds";
    std::vector<std::string> parts;  ///< among choices, wear, runs, scans; empty: all
    std::vector<std::string> faces;  ///< meshes of faces in correspondence
    int objects = 40, casts = 43, seeds = 3;
    std::uint64_t vertices = 10000;
};
void moulds(const MouldExperimentOptions& options);

/// Fits templates to other members with known correspondence, with each rule for the counterparts of vertices.
struct CounterpartExperiment {
    std::string output = "experiments-output/counterparts";
    std::vector<std::string> objects{"statuette", "hand", "teapot", "vase", "chair"};
    std::vector<std::string> pairs;  ///< TEMPLATE=MEMBER: mesh files in correspondence
    std::vector<std::string> cases;  ///< by name or number; empty: all
    std::vector<std::string> ways{"nearest", "surface", "one-to-one", "sliding"};
    std::uint64_t vertices = 3000, seed = 1;
    double strength = 0.2;  ///< standard deviation of the logarithm of the size of parts
};
void counterparts(const CounterpartExperiment& options);

/// Registers broken pieces to whole objects by pose search.
struct PoseSearchExperiment {
    std::vector<std::string> wholes;     ///< mesh files, or made:NAME; pieces of the same object
    std::vector<std::string> members;    ///< TEMPLATE=MEMBER: pieces of another member of the class, in the same frame
    std::vector<std::string> strangers;  ///< TEMPLATE=OTHER: pieces of unrelated objects
    std::vector<double> shares{0.1, 0.25, 0.5}, noises{0.001, 0.005};
    double erosion = 0.005;
    int pieces = 10;
    bool corresponding = true;  ///< meshes with the same number of vertices are in correspondence
    std::uint64_t vertices = 25000;
    PoseSearchOptions search;
    std::string csv;
};
void pose_search(const PoseSearchExperiment& options);

/// Joins fragments by their fracture surfaces.
struct BreakExperiment {
    std::string output = "experiments-output/breaks";
    std::string data = "../shared/data";  ///< folder with fragments-bottle-pair and fragments-vessel-sherds
    int motions = 3;                      ///< number of random motions of all sherds
    int pots = 4;                         ///< number of synthetic vessels of each kind
    int first = 0;                        ///< number of vessels to skip
    bool write = false;                   ///< whether to write the sherds too
};
struct JoinExperiment {
    std::vector<std::string> boxes;  ///< see read_box
    std::string output = "experiments-output/joins";
    std::vector<std::string> rows;  ///< joins.csv of earlier runs, as additional training data
    std::string model;              ///< model file to train and write
    std::string recipe;             ///< description of the training, stored in the model
    int pieces = 8;
    std::uint64_t seed = 0;
    std::string facets = "known";  ///< or "found" by the library; "both": found in every second box
    bool adjacent_only = false;    ///< only pairs that touch
};
/// Registers pairs of fragments of broken objects: accuracy of poses and calibration of the confidence.
void joins(const JoinExperiment& options);

/// Reassembles boxes that contain the fragments of one object and unrelated fragments, one from each other box.
struct AssemblyExperiment {
    std::vector<std::string> boxes;  ///< see read_box
    std::string output = "experiments-output/assemblies";
    int pieces = 10;
    int strangers = 10;  ///< number of unrelated fragments per box, at most the number of other boxes
    std::uint64_t seed = 0;
    bool found = false;  ///< found facets instead of known ones
    ReassemblyOptions reassembly;
};
void assemblies(const AssemblyExperiment& options);

struct FacetExperiment {
    int objects = 20;                  ///< number of training objects of each kind
    std::uint64_t seed = 1;            ///< for objects and fractures
    BoostOptions boosting;             ///< see stats/boosted_trees.h
    std::string model;                 ///< model file to train and write
    std::vector<std::string> meshes;   ///< folders of mesh files of whole objects for training
    std::vector<std::string> scanned;  ///< folders of broken objects for training
    std::vector<std::string> judged;   ///< sources for evaluation, see facet_cases
    std::string pictures;              ///< folder for coloured meshes of the evaluated fragments
    bool each = false;                 ///< one row per fragment
};
/// Classifies fracture and intact surface, evaluated on held-out objects and on others.
void facets(const FacetExperiment& options);

/// Places sherds on the surface of revolution made of them: errors of axes, heights and rotations.
void sherd_rotations(const BreakExperiment& options);
/// Synthetic vessels, broken: rotations from fractures with wear, noise, a missing piece, a piece of another vessel.
void broken_pots(const BreakExperiment& options);
/// Synthetic vessels, broken: surfaces of revolution from sherds that are well placed, badly placed, or unrelated.
void turned_sherds(const BreakExperiment& options);

}  // namespace ostraka::experiments
