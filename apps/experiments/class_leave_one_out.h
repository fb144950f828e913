// Leave-one-out classification: classes are learnt from fits of one template each, and each object is classified by classes
// learnt without it.
#pragma once

#include "class_objects.h"
#include "harness.h"
#include "scenes.h"

#include "ostraka/shape_classes/classify.h"

#include <array>
#include <map>
#include <set>

namespace ostraka::experiments {

/// Settings of the fits of templates to objects.
struct FitSettings {
    std::string output = "experiments-output/classes";
    std::uint64_t template_vertices = 1000, object_vertices = 3000;
    int tries = 1;
    double search_radius = 0.1;
    void list_options(OptionList& list) { list("output", output, "output folder"); }
};

inline constexpr std::size_t every = 1000;  ///< number of members: all available

/// Variant of learning and classification.
struct Way {
    bool shared = true;     ///< thresholds of the classes are moderated by each other
    bool strangers = true;  ///< out-of-class objects determine the acceptance limits
    bool strict = false;    ///< of ClassifyOptions
    std::size_t members = every;
    double accept = 0.05;  ///< of LearnOptions
    bool own = true;       ///< include the object's own class among the classes
    [[nodiscard]] std::string file() const {
        return std::string(shared ? "" : "-alone") + (strangers ? "" : "-members") + (strict ? "-strict" : "") +
               (members < every ? "-of" + std::to_string(members) : "");
    }
    [[nodiscard]] std::string text() const {
        return std::string(shared ? "" : "; each class by its own members' deviations alone") +
               (strangers ? "" : "; without strangers") +
               (strict ? "; the template has to lie on the object by the fixed limit" : "") +
               (members < every ? "; of " + std::to_string(members) + " members" : "");
    }
};

/// Counts of recognised, refused and accepted objects.
struct Rates {
    std::size_t objects = 0, recognised = 0, refused = 0, asked = 0, accepted = 0, open = 0;

    /// Adds the answers about one object of class `of`; with `only`, the answers of these classes only.
    void add(const std::vector<ClassAnswer>& list, const std::string& of, const std::set<std::string>& only = {});
    /// Percentages of objects recognised by their own class, accepted by another one, and by any other one.
    [[nodiscard]] std::string text() const;
};
class LeaveOneOut {
public:
    /// Fits the templates. The first training object of each class provides its template; for that object itself, the second
    /// does.
    LeaveOneOut(const std::vector<ClassObject>& objects, const FitSettings& settings);

    /// Classifies every object with classes learnt without it.
    void ask(std::size_t arm, const Way& way) const;
    /// Recognition and acceptance rates for increasing permitted shares of accepted out-of-class objects, by number of members.
    void ask_at_rates(std::size_t arm, bool shared, const std::vector<std::size_t>& members,
                      const std::vector<double>& rates) const;
    /// Classifies out-of-class objects with all classes and all their members.
    void ask_made(const std::vector<ClassObject>& made, std::size_t arm) const;

private:
    /// A class's template, made from one object, with the measurements from its fits to other objects.
    struct Source {
        std::string class_name;
        std::size_t object = 0;
        Mesh mesh;
        AnnotationSet parts;
        std::map<std::size_t, MemberFit> fits;                        ///< by object
        std::array<std::map<std::size_t, LearntMember>, 3> measured;  ///< [available information], by object
    };

    /// The classes learnt without an object.
    struct Classes {
        std::vector<const Source*> sources;
        std::vector<ShapeClass> learnt;
    };

    void fit(Source& source, bool second, Rows& csv, std::vector<double>& seconds);
    void measure(Source& source, std::size_t i);
    [[nodiscard]] Classes classes_for(std::size_t object, std::size_t arm, const Way& way) const;
    [[nodiscard]] std::vector<ClassAnswer> answers_of(const Classes& known, std::size_t object, std::size_t arm,
                                                      const Way& way) const;
    /// Learns a class. The out-of-class objects are those of the other classes, except the class of the object to be
    /// classified, which is treated as unseen.
    [[nodiscard]] ShapeClass learnt_from(const Source& source, std::size_t arm, std::size_t without, const Way& way) const;
    [[nodiscard]] std::set<std::string> first_half() const;
    [[nodiscard]] std::set<std::string> rest(const std::set<std::string>& half) const;

    const std::vector<ClassObject>& objects_;
    const FitSettings settings_;
    std::map<std::string, std::vector<std::size_t>> objects_of_class_;
    std::vector<Source> sources_;
    LearnOptions how_;
    const AnnotationSet none_;
    const RelationGraph no_graph_;
};

}  // namespace ostraka::experiments
