// Compiled by test spheres_do_not_compile: with DIM = 3 it must not compile, and say why; with DIM = 2 it must.
#include <isostat/contact/state.hpp>

isostat::State<DIM> state;
