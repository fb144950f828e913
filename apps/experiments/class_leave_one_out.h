// Classes learnt from members by fits of one template each; every object answered by classes that do not know it.
#pragma once

#include "class_objects.h"
#include "classes.h"

#include "ostraka/shape_classes/classify.h"

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace ostraka::experiments {

inline constexpr std::size_t every = 1000;  ///< members: all that there are

/// How the classes are learnt and asked.
struct Way {
    bool shared = true;     ///< the classes moderate each other's deviations
    bool strangers = true;  ///< objects of other classes say up to where one is recognised
    bool strict = false;    ///< of ClassifyOptions
    std::size_t members = every;
    double accept = 0.05;  ///< of LearnOptions
    bool own = true;       ///< the object's class is asked together with the others; else these are asked without it
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

/// What is recognised and what is accepted.
struct Rates {
    std::size_t objects = 0, recognised = 0, refused = 0, asked = 0, accepted = 0, open = 0;

    /// The answers about one object of a class; with `only`, of these classes.
    void add(const std::vector<ClassAnswer>& list, const std::string& of, const std::set<std::string>& only = {});
    /// Per cent of the objects recognised by their own class, accepted by another one, and by any other one.
    [[nodiscard]] std::string text() const;
};
/// Per cent.
std::string share_of(std::size_t part, std::size_t all);

class LeaveOneOut {
public:
    LeaveOneOut(const std::vector<ClassObject>& objects, const ClassMembershipOptions& options);

    /// The first object that is learnt from of each class makes its template, for that one itself the second does.
    void fit(const ClassMembershipOptions& options);
    /// Every object asked of classes that do not know it.
    void ask(std::size_t arm, const Way& way, const ClassMembershipOptions& options) const;
    /// What is recognised and what is accepted as the share of strangers that may be accepted rises, by the number of members.
    void ask_at_rates(std::size_t arm, bool shared, const std::vector<std::size_t>& members,
                      const std::vector<double>& rates) const;
    /// Objects of no class asked of all classes with all their members.
    void ask_made(const std::vector<ClassObject>& made, std::size_t arm) const;

private:
    /// A class's template, made from one object, and what is measured where it lies on the others.
    struct Source {
        std::string class_name;
        std::size_t object = 0;
        Mesh mesh;
        AnnotationSet parts;
        std::map<std::size_t, MemberFit> fits;                        ///< by object
        std::array<std::map<std::size_t, LearntMember>, 3> measured;  ///< by what is known, then by object
    };

    /// Those that do not know an object.
    struct Classes {
        std::vector<const Source*> sources;
        std::vector<ShapeClass> learnt;
    };

    void measure(Source& source, std::size_t i);
    [[nodiscard]] Classes classes_for(std::size_t object, std::size_t arm, const Way& way) const;
    [[nodiscard]] std::vector<ClassAnswer> answers_of(const Classes& known, std::size_t object, std::size_t arm,
                                                      const Way& way) const;
    /// Strangers are objects of the other classes, but none of the class of the object that will be asked: it is of a kind
    /// unseen.
    [[nodiscard]] ShapeClass learnt_from(const Source& source, std::size_t arm, std::size_t without, const Way& way) const;
    [[nodiscard]] std::set<std::string> first_half() const;
    [[nodiscard]] std::set<std::string> rest(const std::set<std::string>& half) const;

    const std::vector<ClassObject>& objects_;
    std::map<std::string, std::vector<std::size_t>> objects_of_class_;
    std::vector<Source> sources_;
    LearnOptions how_;
    const AnnotationSet none_;
    const RelationGraph no_graph_;
};

}  // namespace ostraka::experiments
