// Parameters of constraints as types, one for each type of relationship or for several alike (doc/deformation.md).
//
// Files state them as a JSON object. It is read here and nowhere else: each type has a constructor from the object, which reads
// the parameters that it knows.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/relation/graph.h"
#include "ostraka/solver/make_constraint.h"

#include <set>
#include <variant>

namespace ostraka::semantic {

using kinds::Interval;

/// Reads the parameters of one constraint. Errors (input) name the file and the constraint.
class ParameterReader {
public:
    ParameterReader(const Relationship& relationship, std::string place);

    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;
    [[nodiscard]] bool flag(const char* name) const;
    [[nodiscard]] std::optional<double> number(const char* name, double minimum, double maximum) const;
    [[nodiscard]] std::optional<Vector3d> vector(const char* name) const;
    /// A vector of unit length.
    [[nodiscard]] std::optional<Vector3d> direction(const char* name) const;
    /// The place of the word among those that the parameter may have; nothing without the parameter.
    [[nodiscard]] std::optional<std::size_t> word(const char* name, std::initializer_list<const char*> words) const;
    template <class Enum>
    [[nodiscard]] Enum word(const char* name, std::initializer_list<const char*> words, Enum otherwise) const {
        const std::optional<std::size_t> place = word(name, words);
        return place ? static_cast<Enum>(*place) : otherwise;
    }
    /// An id, or a name or tag.
    [[nodiscard]] std::optional<std::variant<int, std::string>> id_or_name(const char* name) const;
    /// minValue and maxValue (Appendix B.2), positive; nothing if both are absent.
    [[nodiscard]] std::optional<Interval> range() const;
    /// Rejects parameters that were not read (likely typos).
    void refuse_others() const;

    [[nodiscard]] const JsonValue* given(const char* name) const;

private:
    std::string place_;
    Json parameters_;
    mutable std::set<std::string> read_;
};

/// The member that the others follow.
struct Leader {
    Leader() = default;
    explicit Leader(const ParameterReader& read);
    bool any = false;                                          ///< members follow one of them
    std::optional<std::variant<int, std::string>> named = {};  ///< by id or tag; default: the one that the edit moves most
};

/// Which measure of an annotation a parameter means.
struct MeasureName {
    MeasureName(const ParameterReader& read, const char* name) : parameter(name), measure(read.id_or_name(name)) {}
    const char* parameter;
    std::optional<std::variant<int, std::string>> measure;  ///< by id or name; default: the only one
};

namespace spec {

/// Types without parameters.
struct None {
    explicit None(const ParameterReader&) {}
};
struct KeepShape {
    explicit KeepShape(const ParameterReader& read);
    enum class Mode { rigid, similar, seat } mode;
    double bend = 0;  ///< of seated parts
};
struct SameLevel {
    explicit SameLevel(const ParameterReader& read);
    std::optional<Vector3d> up;
    enum class Shapes { keep, similar, free, seat } shapes;
    enum class Reference { mean, vertex, base } reference;
    enum class Heights { rest, equal };
    std::optional<Heights> heights;  ///< default: those at rest if they are nearly equal
    double bend = 0;                 ///< of seated parts
    Leader leader;
};
struct StructuralContinuity {
    explicit StructuralContinuity(const ParameterReader& read);
    double angle;  ///< degrees
};
/// How a part changes with its measure.
enum class SizeMode { stretch, scale };
struct Proportion {
    explicit Proportion(const ParameterReader& read);
    MeasureName first, second;
    std::optional<Interval> range;  ///< default: the ratio at rest
    SizeMode mode;
    Leader leader;
};
struct KeepMeasure {
    explicit KeepMeasure(const ParameterReader& read);
    MeasureName measure;
    std::optional<Interval> range;  ///< default: the value at rest
    SizeMode mode;
};
struct SameMeasure {
    explicit SameMeasure(const ParameterReader& read);
    MeasureName measure;
    SizeMode mode;
    Leader leader;
};
struct MirrorSymmetry {
    explicit MirrorSymmetry(const ParameterReader& read);
    std::optional<kinds::MirrorPlane> plane;  ///< default: that at rest
    Leader leader;                            ///< of two parts
};
/// Support and contact of parts.
struct Upward {
    explicit Upward(const ParameterReader& read) : up(read.direction("direction")) {}
    std::optional<Vector3d> up;
};
/// Part similarity and same length.
struct Alike {
    explicit Alike(const ParameterReader& read) : leader(read) {}
    Leader leader;
};
struct KeepDirection {
    explicit KeepDirection(const ParameterReader& read);
    std::optional<Vector3d> up;
    std::optional<double> angle;  ///< to up, degrees; default: that at rest
};
struct KeepPosition {
    explicit KeepPosition(const ParameterReader& read) : place(read.vector("point")) {}
    std::optional<Vector3d> place;  ///< default: that at rest
};

}  // namespace spec

}  // namespace ostraka::semantic
