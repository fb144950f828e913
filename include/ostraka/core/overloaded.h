// Case distinction over the alternatives of a std::variant.
#pragma once

namespace ostraka {

/// One function object from several: std::visit(Overloaded{[](int) {...}, [](const auto&) {...}}, variant).
template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};

template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace ostraka
