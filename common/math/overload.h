// A visitor of variants made of lambdas, one a case: a case that is missing does not compile.
#pragma once

namespace rayfarm {

template <class... Cases>
struct Overload : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overload(Cases...) -> Overload<Cases...>;

}  // namespace rayfarm
