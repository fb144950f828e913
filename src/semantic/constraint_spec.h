// Parameters of constraints as C++ types, one type for each type of relationship or for several similar types
// (doc/deformation.md).
//
// Files state the parameters of a constraint as a JSON object. Only the constructors in this header read this object: each type
// reads the parameters that it uses.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/relation/graph.h"
#include "ostraka/solver/make_constraint.h"

#include <set>
#include <variant>

namespace ostraka::semantic {

using kinds::Interval;

/// Reads the parameters of one constraint from its JSON object. Errors (input) name the file and the constraint.
class ParameterReader {
public:
    ParameterReader(const Relationship& relationship, std::string place);

    /// Throws Error (input) with the problem and the remedy.
    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;
    [[nodiscard]] bool flag(const char* name) const;  ///< value of a boolean parameter; false if absent
    /// Value within [minimum, maximum]; empty if absent.
    [[nodiscard]] std::optional<double> number(const char* name, double minimum, double maximum) const;
    [[nodiscard]] std::optional<Vector3d> vector(const char* name) const;  ///< three numbers; empty if absent
    /// A direction, normalised to unit length; empty if absent.
    [[nodiscard]] std::optional<Vector3d> direction(const char* name) const;
    /// Index in `words` of the parameter's value; empty if the parameter is absent.
    [[nodiscard]] std::optional<std::size_t> word(const char* name, std::initializer_list<const char*> words) const;
    /// Value of a parameter whose words name the values of an enumeration; `otherwise` if the parameter is absent.
    template <class Enum>
    [[nodiscard]] Enum word(const char* name, std::initializer_list<const char*> words, Enum otherwise) const {
        const std::optional<std::size_t> place = word(name, words);
        return place ? static_cast<Enum>(*place) : otherwise;
    }
    /// An id, or a name or tag; empty if absent.
    [[nodiscard]] std::optional<std::variant<int, std::string>> id_or_name(const char* name) const;
    /// The parameters minValue and maxValue (Appendix B.2), positive; empty if both are absent.
    [[nodiscard]] std::optional<Interval> range() const;
    /// Throws Error (input) for parameters that were not read (likely typos).
    void refuse_others() const;

    /// JSON value of a parameter, which counts as read; null if absent.
    [[nodiscard]] const JsonValue* given(const char* name) const;

private:
    std::string place_;
    Json parameters_;
    mutable std::set<std::string> read_;  ///< names of the parameters that were read
};

/// Specifies the leader: the member that the other members follow.
struct Leader {
    Leader() = default;
    explicit Leader(const ParameterReader& read);
    bool any = false;  ///< true: the other members follow one member
    /// Id or tag of the leader; empty: the member that the edit moves most.
    std::optional<std::variant<int, std::string>> named = {};
};

/// Specifies a measure of an annotation.
struct MeasureName {
    MeasureName(const ParameterReader& read, const char* name) : parameter(name), measure(read.id_or_name(name)) {}
    const char* parameter;  ///< name of the parameter
    /// Id or name of the measure; empty: the only measure of the annotation.
    std::optional<std::variant<int, std::string>> measure;
};

namespace spec {

/// Parameters of types that have none.
struct None {
    explicit None(const ParameterReader&) {}
};
/// The part keeps its shape: exactly, up to its size, or seated on the deformed base as a rigid detail.
struct KeepShape {
    explicit KeepShape(const ParameterReader& read);
    enum class Mode { rigid, similar, seat } mode;  ///< rigid: exact shape; similar: up to size; seat: seated on the base
    double bend = 0;                                ///< for seated parts: max bending onto the base
};
/// Parts stay on one level.
struct SameLevel {
    explicit SameLevel(const ParameterReader& read);
    std::optional<Vector3d> up;                              ///< upward direction; empty: the upward direction of the annotations
    enum class Shapes { keep, similar, free, seat } shapes;  ///< whether the parts keep their shape
    /// The point of a part whose height counts.
    enum class Reference { mean, vertex, base } reference;
    enum class Heights { rest, equal };
    /// Heights that parts keep: at rest, or equal; empty: at rest if the heights at rest are nearly equal.
    std::optional<Heights> heights;
    double bend = 0;  ///< for seated parts: max bending onto the base
    Leader leader;    ///< the part that the others follow
};
/// A part continues the axis of another part.
struct StructuralContinuity {
    explicit StructuralContinuity(const ParameterReader& read);
    double angle;  ///< max deviation from the axis, degrees
};
/// How a part changes when its measure changes.
enum class SizeMode { stretch, scale };
/// Two measures have a ratio in a range.
struct Proportion {
    explicit Proportion(const ParameterReader& read);
    MeasureName first, second;      ///< measures of the first and of the second part
    std::optional<Interval> range;  ///< range of the ratio; empty: the ratio at rest
    SizeMode mode;                  ///< how a part changes with its measure
    Leader leader;                  ///< the part that the other follows
};
/// A measure stays in a range.
struct KeepMeasure {
    explicit KeepMeasure(const ParameterReader& read);
    MeasureName measure;            ///< name of the measure
    std::optional<Interval> range;  ///< range of the measure; empty: the value at rest
    SizeMode mode;                  ///< how the part changes with its measure
};
/// A measure is equal on all parts.
struct SameMeasure {
    explicit SameMeasure(const ParameterReader& read);
    MeasureName measure;  ///< name of the measure
    SizeMode mode;        ///< how a part changes with its measure
    Leader leader;        ///< the part that the others follow
};
/// Parts are mirror-symmetric.
struct MirrorSymmetry {
    explicit MirrorSymmetry(const ParameterReader& read);
    std::optional<kinds::MirrorPlane> plane;  ///< mirror plane; empty: the mirror plane at rest
    Leader leader;                            ///< leader, for two parts
};
/// Parameters of horizontal support and side contact.
struct Upward {
    explicit Upward(const ParameterReader& read) : up(read.direction("direction")) {}
    std::optional<Vector3d> up;  ///< upward direction; empty: the upward direction of the annotations
};
/// Parameters of part similarity and same length.
struct Alike {
    explicit Alike(const ParameterReader& read) : leader(read) {}
    Leader leader;  ///< the part that the others follow
};
/// The axis of a part keeps its angle to the upward direction.
struct KeepDirection {
    explicit KeepDirection(const ParameterReader& read);
    std::optional<Vector3d> up;   ///< upward direction; empty: the upward direction of the annotations
    std::optional<double> angle;  ///< angle to the upward direction, degrees; empty: the angle at rest
};
/// A part keeps its position.
struct KeepPosition {
    explicit KeepPosition(const ParameterReader& read) : place(read.vector("point")) {}
    std::optional<Vector3d> place;  ///< position; empty: the position at rest
};

}  // namespace spec

}  // namespace ostraka::semantic
