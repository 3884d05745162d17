// Binds State and Packing, whose arrays view the library's memory.
#include "certificate/averages.hpp"
#include "checker/run_records.hpp"
#include "contact/words.hpp"
#include "convert.hpp"
#include "core/refuse.hpp"
#include "io/equilibria.hpp"
#include "packing/words.hpp"
#include "rigidity/isostatic.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/rigidity/counting.hpp>

#include <algorithm>

namespace isostat::python {

namespace {

WallKind wall_kind(const std::string& name) {
    if (const auto kind = value_of(name, wall_kind_words)) {
        return *kind;
    }
    throw Error(ErrorKind::bad_input, "wall is \"" + name + "\": expected absent, fixed or movable");
}

/// The first `dimension` entries.
template <class T> std::vector<T> per_axis(const PerAxis<T>& values, int dimension) {
    return std::vector<T>(values.begin(),
                          values.begin() + dimension); // NOLINT(modernize-return-braced-init-list): bool
}

As<"dict[str, tuple[str, str]]"> walls_dict(const Walls& walls, int dimension) {
    const auto words = [dimension](const PerAxis<WallKind>& kinds) {
        PerAxis<std::string> names;
        std::ranges::transform(kinds, names.begin(), [](WallKind kind) { return word_of(kind, wall_kind_words); });
        return py::tuple(py::cast(per_axis(names, dimension)));
    };
    py::dict dict;
    dict["lower"] = words(walls.lower);
    dict["upper"] = words(walls.upper);
    return dict;
}

As<"list[tuple[int, int, float]]"> bar_rows(const Packing& packing) {
    py::list rows;
    for (const Bar& bar : packing.bars) {
        rows.append(py::make_tuple(bar.i, bar.j, bar.length));
    }
    return rows;
}

As<"list[tuple[int, ...]]"> arc_rows(const Packing& packing) {
    py::list rows;
    for (const std::vector<int>& ring : packing.arcs) {
        rows.append(py::tuple(py::cast(ring)));
    }
    return rows;
}

/// Binds the properties of a packing, also for a state; `of` returns the packing of an object.
template <class Bound, class Of> void bind_grains(Bound& bound, const Of& of) {
    bound
        .def_property_readonly(
            "positions",
            [of](const py::object& self) {
                const Packing& packing = of(self);
                return view(packing.q.data(), {packing.disk_count(), packing.dimension}, self);
            },
            "(n, d) centres; length. A read-only view.")
        .def_property_readonly(
            "length",
            [of](const py::object& self) {
                const Packing& packing = of(self);
                return view(packing.q.data() + packing.length_at(0), {packing.dimension}, self);
            },
            "(d,) positions of the right, top and front wall, or the periods of a cell; length. A read-only view.")
        .def_property_readonly(
            "radii", [of](const py::object& self) { return view(of(self).radius, self); },
            "(n,) radii; length. A read-only view.")
        .def_property_readonly(
            "fixed", [of](const py::object& self) { return view(of(self).fixed, self); },
            "(n,) flags, 1: cannot move; empty where no disk is fixed.")
        .def_property_readonly(
            "bars", [of](const py::object& self) { return bar_rows(of(self)); },
            "(i, j, length): two members of a clump and the distance of their centres; empty without clumps.")
        .def_property_readonly(
            "arcs", [of](const py::object& self) { return arc_rows(of(self)); },
            "Bodies bounded by arcs: their members, counterclockwise; empty where all bodies are unions of disks.")
        .def_property_readonly(
            "walls", [of](const py::object& self) { return walls_dict(of(self).walls, of(self).dimension); },
            "{\"lower\": (left, bottom), \"upper\": (right, top)}, of spheres (left, bottom, back), (right, top, "
            "front), each \"absent\", \"fixed\" or \"movable\".")
        .def_property_readonly(
            "tilt",
            [of](const py::object& self) -> As<"Optional[float]"> {
                const Packing& packing = of(self);
                if (packing.cell.any() && packing.dimension != plane) {
                    return py::object(
                        py::make_tuple(packing.lattice(0, 1), packing.lattice(0, 2), packing.lattice(1, 2)));
                }
                return packing.cell.any() ? py::object(py::float_(packing.lattice(0, 1))) : py::object(py::none());
            },
            "Of a periodic cell: x of the second period, of spheres (xy, xz, yz); None in a box.")
        .def_property_readonly(
            "periodic",
            [of](const py::object& self) -> As<"tuple[bool, bool]"> {
                return py::tuple(py::cast(per_axis(of(self).cell.periodic, of(self).dimension)));
            },
            "Along x, y (and z): whether the packing repeats.")
        .def_property_readonly(
            "solid_fraction", [of](const py::object& self) { return of(self).solid_fraction(); },
            "Area of the disks over that of the box; of spheres volumes; of a clump that of its union.")
        .def_property_readonly(
            "dof_names", [of](const py::object& self) { return dof_names(of(self)); },
            "Names of the N_f degrees of freedom, in their order: \"x of disk 3\", \"top wall\".");
}

/// Moves a vector into an array without a copy.
template <class T> py::array taken(std::vector<T>&& vector) {
    auto* kept = new std::vector<T>(std::move(vector));
    const py::capsule owner(kept, [](void* pointer) { delete static_cast<std::vector<T>*>(pointer); });
    return py::array(py::dtype::of<T>(), {static_cast<py::ssize_t>(kept->size())}, {}, kept->data(), owner);
}

/// (data, indices, indptr) and shape, which are the arguments of scipy.sparse.csc_matrix.
As<"tuple[tuple[Floats, Integers, Integers], Pair]"> matrix_parts(const State& state) {
    SparseColumns h = contact_matrix(state);
    return py::make_tuple(py::make_tuple(taken(std::move(h.value)), taken(std::move(h.row)), taken(std::move(h.start))),
                          py::make_tuple(h.rows, h.columns));
}

/// (contact, row, column, value): second derivatives of the gaps with respect to two degrees of freedom.
As<"tuple[Integers, Integers, Integers, Floats]"> curvature_parts(const State& state) {
    const Packing& packing = state.packing;
    if (packing.cell.keeps_shape) {
        throw Error(ErrorKind::bad_input, "an isotropic cell is written as one of which a period moves, which has the "
                                          "same forces and counts, and another stiffness: expected another cell");
    }
    const DofMap dofs(packing);
    std::vector<int> contact, row, column;
    std::vector<double> value, velocity(packing.q.size(), 0);
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const GapGradient gradient = gap_gradient(packing, state.contacts[l]);
        const auto along = [&](int a, int b) { // the quadratic form along e_a + e_b
            const auto i = static_cast<std::size_t>(gradient.coordinate[static_cast<std::size_t>(a)]),
                       j = static_cast<std::size_t>(gradient.coordinate[static_cast<std::size_t>(b)]);
            velocity[i] += 1;
            velocity[j] += 1;
            const double curvature = gap_curvature(packing, state.contacts[l], velocity.data());
            velocity[i] = velocity[j] = 0;
            return curvature;
        };
        const auto dof = [&](int a) {
            return dofs.dof_of(static_cast<std::size_t>(gradient.coordinate[static_cast<std::size_t>(a)]));
        };
        for (int a = 0; a < gradient.count; ++a) {
            for (int b = 0; b < gradient.count; ++b) {
                if (dof(a) >= 0 && dof(b) >= 0) {
                    contact.push_back(static_cast<int>(l));
                    row.push_back(dof(a));
                    column.push_back(dof(b));
                    value.push_back(a == b ? along(a, a) / 4 : (along(a, b) - along(a, a) / 4 - along(b, b) / 4) / 2);
                }
            }
        }
    }
    return py::make_tuple(taken(std::move(contact)), taken(std::move(row)), taken(std::move(column)),
                          taken(std::move(value)));
}

/// All data of a packing, for copies.
py::tuple packing_parts(const Packing& p) {
    require_single_grains(p, "Packing", "a copy");
    const Cell& c = p.cell;
    PerAxis<std::array<int, 2>> walls{};
    std::ranges::transform(p.walls.lower, p.walls.upper, walls.begin(), [](WallKind lower, WallKind upper) {
        return std::array{static_cast<int>(lower), static_cast<int>(upper)};
    });
    return py::make_tuple(p.dimension, p.radius, p.q, p.fixed, walls, c.periodic, c.period_moves, c.tilt_moves, c.pin,
                          c.keeps_shape);
}

Packing packing_of_parts(const py::tuple& parts) {
    Packing p;
    std::size_t at = 0;
    const auto take = [&](auto& member) { member = parts[at++].cast<std::decay_t<decltype(member)>>(); };
    take(p.dimension);
    take(p.radius);
    take(p.q);
    take(p.fixed);
    PerAxis<std::array<int, 2>> walls{};
    take(walls);
    for (std::size_t a = 0; a < walls.size(); ++a) {
        p.walls.lower[a] = static_cast<WallKind>(walls[a][0]);
        p.walls.upper[a] = static_cast<WallKind>(walls[a][1]);
    }
    take(p.cell.periodic);
    take(p.cell.period_moves);
    take(p.cell.tilt_moves);
    take(p.cell.pin);
    take(p.cell.keeps_shape);
    p.cell.dimension = p.dimension;
    validate(p, "Packing");
    return p;
}

Packing packing_of(const py::array_t<double, py::array::c_style | py::array::forcecast>& centres,
                   const std::vector<double>& radii, const std::vector<double>& length,
                   const std::optional<std::vector<std::string>>& lower,
                   const std::optional<std::vector<std::string>>& upper, const std::vector<bool>& fixed) {
    const py::ssize_t d = centres.ndim() == 2 ? centres.shape(1) : 0;
    if ((d != 2 && d != 3) || static_cast<std::size_t>(centres.shape(0)) != radii.size()) {
        refuse("positions", "expected an array of shape (n, 2), of spheres (n, 3), for n radii");
    }
    if (!fixed.empty() && fixed.size() != radii.size()) {
        refuse("fixed", "expected one flag per disk");
    }
    Packing packing;
    packing.dimension = packing.cell.dimension = static_cast<int>(d);
    packing.walls = Walls::box(packing.dimension);
    packing.radius = radii;
    packing.q.assign(centres.data(), centres.data() + centres.size());
    packing.q.insert(packing.q.end(), length.begin(), length.end());
    packing.fixed.assign(fixed.begin(), fixed.end());
    const auto expect = [&](const char* name, std::size_t size) {
        if (size != packing.axes()) {
            refuse(ErrorKind::bad_input, "{} has {} entries: expected {}, one per axis", name, size, packing.axes());
        }
    };
    expect("length", length.size());
    const auto take = [&](const char* name, const auto& words, PerAxis<WallKind>& walls) {
        if (words) {
            expect(name, words->size());
            std::ranges::transform(*words, walls.begin(), wall_kind);
        }
    };
    take("lower", lower, packing.walls.lower);
    take("upper", upper, packing.walls.upper);
    validate(packing, "Packing");
    return packing;
}

void bind_packing(py::module_& module) {
    py::class_<Packing, std::shared_ptr<Packing>> packing(
        module, "Packing",
        "Disks or spheres and walls: positions, radii, box. No contacts, no load.\n\nPacking(positions, radii, length, "
        "*, "
        "lower=(\"fixed\", ...), upper=(\"movable\", ...), fixed=[]): (n, 2) and (n,) floats, (Lx, Ly), of spheres (n, "
        "3) "
        "and (Lx, Ly, Lz); `fixed` has a flag per grain.");
    packing
        .def(py::init(&packing_of), py::arg("positions"), py::arg("radii"), py::arg("length"), py::kw_only(),
             py::arg("lower") = py::none(), py::arg("upper") = py::none(), py::arg("fixed") = std::vector<bool>{})
        .def("__len__", &Packing::disk_count)
        .def(py::pickle(&packing_parts, &packing_of_parts));
    bind_grains(packing, [](const py::object& self) -> const Packing& { return self.cast<const Packing&>(); });
}

using StateClass = py::class_<PyState, std::shared_ptr<PyState>>;

const State& state_of(const py::object& self) {
    return self.cast<const PyState&>().state;
}

void bind_contacts(StateClass& state) {
    state
        .def_property_readonly(
            "contacts", [](const PyState& self) { return contact_array(self.state.contacts); },
            "(N, 2) integers: disks i < j; or a disk and -1 left, -2 bottom, -3 right, -4 top wall, of spheres -5 "
            "back, -6 front; or a held coordinate and -9; or two members i < j of a clump as i and -10 - j. A copy.")
        .def_property_readonly(
            "images",
            [](const PyState& self) {
                const std::vector<Contact>& contacts = self.state.contacts;
                const std::size_t axes = self.state.packing.axes();
                py::array_t<int> out({contacts.size(), axes});
                auto rows = out.mutable_unchecked<2>();
                for (std::size_t l = 0; l < contacts.size(); ++l) {
                    for (std::size_t a = 0; a < axes; ++a) {
                        const int periods{contacts[l].image.m[a]};
                        rows(static_cast<py::ssize_t>(l), static_cast<py::ssize_t>(a)) = periods;
                    }
                }
                return out;
            },
            "(N, d) integers: the second grain of a contact is moved by so many periods; 0 in a box. A copy.")
        .def_property_readonly(
            "contact_names",
            [](const PyState& self) { return contact_names(self.state.contacts, self.state.packing.dimension); },
            "Names of the N contacts: \"3-7\", \"3-8(1,0)\", \"3-left\".")
        .def_property_readonly("forces", vector_of(&PyState::forces),
                               "(N,) forces that the file has, stress x length, positive in compression; empty where "
                               "it has none. For looking: `inspect` proves them.");
}

void bind_load(StateClass& state) {
    state
        .def_property_readonly(
            "stress",
            [](const PyState& self) { return per_axis(self.state.load.stress, self.state.packing.dimension); },
            "[sigma_1, sigma_2], of spheres sigma_3 too: on the right, top and front wall; positive in compression.")
        .def_property_readonly(
            "reference_length",
            [](const PyState& self) {
                return per_axis(self.state.load.reference_length, self.state.packing.dimension);
            },
            "[Lx, Ly], of spheres Lz too, at which nominal stress and strain are defined; length.")
        .def_property_readonly(
            "loaded_axis", [](const PyState& self) { return self.state.load.loaded_axis; },
            "Axis whose stress a programme changes: 0 or 1 (of spheres 2); d and more: the shear stress on a tilt of a "
            "cell.")
        .def_property_readonly(
            "load", [](const PyState& self) { return word_of(self.state.load.kind, load_kind_words); },
            "\"nominal\": force = stress x reference length; \"true\": force = stress x length.")
        .def_property_readonly(
            "infinitesimal",
            [](const py::object& self) {
                const std::vector<double>& g = state_of(self).load.infinitesimal;
                const auto axes = static_cast<py::ssize_t>(state_of(self).packing.axes());
                return view(g.data(), {static_cast<py::ssize_t>(g.size()) / axes, axes}, self);
            },
            "(n, d) infinitesimal loads, on which rattlers rest, or (0, d).")
        .def_property_readonly(
            "disk_force",
            [](const py::object& self) {
                const std::vector<double>& force = state_of(self).load.disk_force;
                const auto axes = static_cast<py::ssize_t>(state_of(self).packing.axes());
                return view(force.data(), {static_cast<py::ssize_t>(force.size()) / axes, axes}, self);
            },
            "(n, d) external forces on grains, stress x length (of spheres x length squared), or (0, d).")
        .def_property_readonly(
            "external_force",
            [](const PyState& self) {
                const State& s = self.state;
                const std::vector<double> force = on_dofs(s.load.external_force(s.packing), DofMap(s.packing));
                return py::array_t<double>(static_cast<py::ssize_t>(force.size()), force.data());
            },
            "(N_f,) external force on each degree of freedom, stress x length, rounded to nearest.")
        .def(
            "with_loaded_stress",
            [](const PyState& self, double stress) {
                State changed = self.state;
                changed.load.set_loaded_stress(stress);
                return parse_any_state(state_text(changed), "State", Dimensions::any_bodies);
            },
            py::arg("stress"), "The same state where what the programme changes has this value.");
}

void bind_files(StateClass& state) {
    state
        .def_static(
            "read", [](const std::filesystem::path& path) { return read_any_state(path, Dimensions::any_bodies); },
            py::arg("path"), py::call_guard<py::gil_scoped_release>(),
            "Reads a state file or a plain vertex text. Raises BadInput with file, field, value.")
        .def_static(
            "parse",
            [](const std::string& text, const std::string& source) {
                return parse_any_state(text, source, Dimensions::any_bodies);
            },
            py::arg("text"), py::arg("source") = "State", py::call_guard<py::gil_scoped_release>(),
            "Reads a state from the text of a file; `source` begins messages.")
        .def(
            "text", [](const PyState& self) { return state_text(self.state, self.forces); },
            "The JSON text of the state file.")
        .def(
            "write",
            [](const PyState& self, const std::filesystem::path& path) { write_state(path, self.state, self.forces); },
            py::arg("path"), "Writes a state file in one step: no partial file. Raises CannotWrite.")
        .def("__len__", [](const PyState& self) { return self.state.packing.disk_count(); })
        .def(py::pickle([](const PyState& self) { return py::make_tuple(state_text(self.state, self.forces)); },
                        [](const py::tuple& text) {
                            return parse_any_state(text[0].cast<std::string>(), "State", Dimensions::any_bodies);
                        }));
}

void bind_state_class(py::module_& module) {
    StateClass state(
        module, "State",
        "A packing with its contacts and its load. It does not change; arrays are read-only views of its memory.");
    bind_files(state);
    bind_grains(state, [](const py::object& self) -> const Packing& { return state_of(self).packing; });
    bind_contacts(state);
    bind_load(state);
    state
        .def_property_readonly(
            "equilibrium", [](const PyState& self) { return self.state.equilibrium; },
            "Number of this equilibrium in its run.")
        .def_property_readonly(
            "provenance", [](const PyState& self) { return self.state.provenance; }, "JSON text: who made it.")
        .def_property_readonly(
            "packing", [](const PyState& self) { return self.state.packing; },
            "The disks and walls, as a Packing (a copy).")
        .def("_matrix", [](const PyState& self) { return matrix_parts(self.state); })
        .def("_curvature",
             [](const PyState& self) {
                 require_single_grains(self.state.packing, "State", "a stiffness matrix");
                 return curvature_parts(self.state);
             })
        .def("_contact_table",
             [](const PyState& self) {
                 const State copy = self.state;
                 return interruptible([copy] { return contact_table(copy, certify(copy)); });
             })
        .def_property_readonly(
            "rattlers",
            [](const PyState& self) {
                require_single_grains(self.state.packing, "State", "a count of rattlers by coordination");
                return rattlers_by_coordination(self.state.packing, self.state.contacts);
            },
            "Numbers of the grains that few contacts hold (at most d), counted until none is left; by forces: "
            "`inspect`.")
        .def(
            "with_stress",
            [](const PyState& self, const std::vector<double>& stress, std::optional<double> shear) {
                State changed = self.state;
                if (stress.size() != changed.packing.axes()) {
                    refuse(ErrorKind::bad_input, "stress has {} numbers: expected {}", stress.size(),
                           changed.packing.axes());
                }
                changed.load.path.reset();
                std::ranges::copy(stress, changed.load.stress.begin());
                changed.load.shear[0] = shear.value_or(changed.load.shear[0]);
                return parse_any_state(state_text(changed), "State", Dimensions::any_bodies);
            },
            py::arg("stress"), py::arg("shear") = py::none(),
            "The same state under other stresses, one per axis, and another shear stress on a tilt xy that moves.");
}

/// The contact of a pair, as `contact_array` writes it.
Contact contact_of(std::pair<int, int> pair, const Packing& packing) {
    const auto [i, j] = pair;
    const int disks = packing.disk_count();
    const auto on_surface = j < 0 ? checker::contact_of_columns(i, j, packing)
                                  : checker::contact_of_columns(std::min(i, j), std::max(i, j), packing);
    if (on_surface) {
        return *on_surface;
    }
    if (j == no_contact && i >= 0 && i < static_cast<int>(packing.q.size())) {
        return {ContactKind::held, i, 0};
    }
    if (j <= first_bar &&
        std::ranges::any_of(packing.bars, [&](const Bar& b) { return b.i == i && b.j == first_bar - j; })) {
        return {ContactKind::bar, i, first_bar - j};
    }
    refuse(ErrorKind::bad_input,
           "contact ({}, {}): expected (i, j) of two of {} grains, or (i, -1) left, (i, -2) bottom, (i, -3) right, (i, "
           "-4) top wall, of spheres (i, -5) back, (i, -6) front, or (i, -9) held coordinate, (i, -10 - j) bar of the "
           "packing",
           i, j, disks);
}

} // namespace

void bind_state(py::module_& module) {
    bind_packing(module);
    bind_state_class(module);
    py::class_<Counting>(module, "Counting", "N_f + h = N + k for the stored coordinates taken as exact numbers.")
        .def_readonly("dofs", &Counting::dof_count, "N_f.")
        .def_readonly("contacts", &Counting::contact_count, "N.")
        .def_readonly("rank", &Counting::rank,
                      "Proved lower bound of the rank of the contact matrix; the rank where `rank_exact` is proved.")
        .def_readonly("h", &Counting::hyperstaticity,
                      "N - rank: self-stresses. An upper bound unless `rank_exact` is proved.")
        .def_readonly("k", &Counting::mechanisms,
                      "N_f - rank: mechanisms, rigid motions included. An upper bound unless `rank_exact` is proved.")
        .def_readonly("rank_exact", &Counting::rank_exact, "Verdict on: `rank` is the rank.")
        .def("__repr__", [](const Counting& self) {
            return "Counting(dofs=" + std::to_string(self.dof_count) +
                   ", contacts=" + std::to_string(self.contact_count) + ", rank=" + std::to_string(self.rank) +
                   ", h=" + std::to_string(self.hyperstaticity) + ", k=" + std::to_string(self.mechanisms) + ")";
        });
    constexpr const char* words_of_count =
        "Counting of the exact contact matrix of stored coordinates: count(state), or count(packing, contacts). An "
        "elimination mod p; the rank is exact where `rank_exact` is proved.";
    module.def(
        "count", [](const PyState& state) { return count_contacts(state.state.packing, state.state.contacts); },
        py::arg("state"), py::call_guard<py::gil_scoped_release>(), words_of_count);
    module.def(
        "count",
        [](const Packing& packing, const std::vector<std::pair<int, int>>& contacts) {
            if (packing.cell.any()) {
                throw Error(ErrorKind::bad_input,
                            "packing is a periodic cell, whose contacts name images, and pairs do "
                            "not: expected count(state)");
            }
            std::vector<Contact> list;
            for (const auto& pair : contacts) {
                list.push_back(contact_of(pair, packing));
            }
            return count_contacts(packing, list);
        },
        py::arg("packing"), py::arg("contacts"), py::call_guard<py::gil_scoped_release>(), words_of_count);
}

} // namespace isostat::python
