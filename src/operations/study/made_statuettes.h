// Shared by the operations that make collections of statuettes: meshes, annotations and their provenance.
#pragma once

#include "operations/study/made_collection.h"

#include "ostraka/collection/statuette_annotations.h"
#include "ostraka/synthetic/statuettes.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka {

/// An operation that makes a population of statuettes.
struct StudyMakeStatuettes : StudyMake {
    static std::string name_of(std::size_t i, std::size_t count) { return "statuette-" + padded(i + 1, count); }
    /// Generates the i-th statuette of a population. If its dimensions give no valid surface (for instance arms that touch the
    /// head), they are drawn again from the same population with another seed, and `drawn` changes. After ten attempts, throws
    /// as generate_statuette does.
    template <class Population>
    static Statuette generate_one(Population population, std::size_t i, StatuetteParameters& drawn) {
        constexpr int attempts = 10;
        for (int attempt = 1;; ++attempt) {
            try {
                return generate_statuette(drawn);
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::failure || attempt == attempts) throw;
            }
            population.seed = (population.seed + 1000003) % 1000000000;
            drawn = draw_population(population).at(i);
        }
    }

    /// Makes the whole population and returns the parameters used. Notes report which were drawn again.
    template <class Population>
    std::vector<StatuetteParameters> make_population(
        Context& context, const Population& population, bool coloured,
        const std::function<void(std::size_t, const Statuette&)>& inspect = {}) const {
        std::vector<StatuetteParameters> all_parameters = draw_population(population);
        std::vector<char> is_drawn_again(all_parameters.size(), 0);
        const std::string command = context.provenance().command;
        make_each("statuettes", all_parameters.size(), [&](std::size_t i) {
            const std::uint64_t seed = all_parameters[i].seed;
            const Statuette statuette = generate_one(population, i, all_parameters[i]);
            is_drawn_again[i] = all_parameters[i].seed != seed ? 1 : 0;
            write_one(name_of(i, all_parameters.size()), statuette, all_parameters[i], command, coloured);
            if (inspect) inspect(i, statuette);
        });
        for (std::size_t i = 0; i < all_parameters.size(); ++i)
            if (is_drawn_again[i] != 0)
                context.note(name_of(i, all_parameters.size()) +
                             " was generated again: its first dimensions gave no valid surface");
        return all_parameters;
    }

    /// Writes mesh and annotations; their provenance holds the parameters of the statuette.
    void write_one(const std::string& name, const Statuette& statuette, const StatuetteParameters& parameters,
                   const std::string& command, bool coloured) const {
        const Provenance provenance{command, declare_options(parameters), {}};
        MeshExtras extras;
        extras.face_labels = statuette.face_labels;
        if (coloured)
            for (const std::int32_t label : statuette.face_labels) {
                const auto& [red, green, blue] = statuette.part_colours[static_cast<std::size_t>(label)];
                extras.face_colours.push_back({red, green, blue, 255});
            }
        write(name, statuette.mesh, extras, provenance);
        write_annotations(folder.in(name + ".ant.json"), {statuette.mesh, annotate_statuette(statuette)}, name + ".ply",
                          provenance);
    }
};

}  // namespace ostraka
