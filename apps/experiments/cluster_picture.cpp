// Figure 3.7 of the thesis: clusters of arbitrary form, as found by DBSCAN.
#include "harness.h"

#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"
#include "ostraka/stats/clustering.h"
#include "ostraka/stats/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>

namespace ostraka::experiments {

namespace {

struct ClusterPictureOptions {
    std::string output;
    void list_options(OptionList& list) { list("output", output, "folder for the plot and its table").positional().required(); }
};

struct Form {
    std::string name;
    int points;
    std::array<double, 2> (*place)(Random& draw);
};

std::array<double, 2> on_arc(Random& draw, double x, double y, double radius, double from, double to) {
    const double angle = draw.uniform(from, to), r = radius + 0.04 * draw.normal();
    return {x + r * std::cos(angle), y + r * std::sin(angle)};
}

constexpr double pi = std::numbers::pi;
const std::vector<Form> forms{{"ring", 220, [](Random& draw) { return on_arc(draw, 0, 0, 1, 0, 2 * pi); }},
                              {"disc in the ring", 80,
                               [](Random& draw) {
                                   return std::array{0.12 * draw.normal(), 0.12 * draw.normal()};
                               }},
                              {"upper arc", 140, [](Random& draw) { return on_arc(draw, 2.6, 0.1, 0.8, 0, pi); }},
                              {"lower arc", 140, [](Random& draw) { return on_arc(draw, 3.4, 0, 0.8, pi, 2 * pi); }},
                              {"scattered", 25, [](Random& draw) {
                                   return std::array{draw.uniform(-1.6, 4.8), draw.uniform(-1.6, 1.6)};
                               }}};

void cluster_picture(const ClusterPictureOptions& options) {
    const Path folder(options.output);
    Random draw(37, 1);
    std::vector<std::array<double, 2>> places;
    std::vector<std::size_t> form_of;
    for (std::size_t f = 0; f < forms.size(); ++f)
        for (int k = 0; k < forms[f].points; ++k) places.push_back(forms[f].place(draw)), form_of.push_back(f);
    Eigen::MatrixXd samples(static_cast<Eigen::Index>(places.size()), 2);
    for (std::size_t i = 0; i < places.size(); ++i) samples.row(static_cast<Eigen::Index>(i)) << places[i][0], places[i][1];
    const double epsilon = 0.22;
    const int minimum = 5;
    const std::vector<int> labels = dbscan(samples, epsilon, minimum);
    Plot plot{"DBSCAN: clusters of any form, and noise", {"x"}, {"y"}};
    plot.equal = true;
    TextTable table({"cluster", "points", "form most of them are drawn from", "of that form"});
    for (int label = -1; label <= *std::max_element(labels.begin(), labels.end()); ++label) {
        PlotSeries series{label < 0 ? "noise" : "cluster " + std::to_string(label + 1)};
        series.joined = false;
        std::map<std::size_t, int> drawn;
        for (std::size_t i = 0; i < places.size(); ++i)
            if (labels[i] == label) series.points.push_back(places[i]), ++drawn[form_of[i]];
        if (series.points.empty()) continue;
        const auto most =
            std::max_element(drawn.begin(), drawn.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
        table.add({series.name, std::to_string(series.points.size()), forms[most->first].name, std::to_string(most->second)});
        plot.series.push_back(std::move(series));
    }
    table.write(folder, "clusters");
    write_plot(folder / "clusters.svg", plot);
    std::cout << table.markdown();
}

const Registration registered("dbscan", "points of several forms and the clusters found among them (figure 3.7)",
                              cluster_picture);

}  // namespace

}  // namespace ostraka::experiments
