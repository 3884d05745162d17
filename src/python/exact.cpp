// Binds exact numbers and crafted packings.
#include "convert.hpp"
#include "crafted/enclosed_bases.hpp"
#include "crafted/genericity.hpp"
#include "io/files.hpp"

#include <isostat/core/result.hpp>
#include <isostat/crafted/exact_packing.hpp>
#include <isostat/exact/number.hpp>

#include <pybind11/operators.h>

#include <map>

namespace isostat::python {

namespace {

using exact::Number;

using Exact = As<"Exact">;
using Exacts = As<"list[Exact]">;
using Rational = As<"Rational">;

/// A fractions.Fraction when the number is rational, otherwise an isostat.Number.
Exact to_python(const Number& number) {
    return number.is_rational() ? py::object(py::module_::import("isostat._exact").attr("fraction")(number.text()))
                                : py::cast(number);
}

Exacts to_python(const std::vector<Number>& vector) {
    py::list list;
    for (const Number& number : vector) {
        list.append(to_python(number));
    }
    return list;
}

As<"list[list[Exact]]"> to_python(const std::vector<std::vector<Number>>& vectors) {
    py::list list;
    for (const auto& vector : vectors) {
        list.append(to_python(vector));
    }
    return list;
}

/// Converts a Number, a float (exactly), an int, a Fraction or a text.
Number to_number(const py::handle& object) {
    if (py::isinstance<Number>(object)) {
        return object.cast<Number>();
    }
    if (py::isinstance<py::float_>(object)) {
        return Number::from_double(finite(object.cast<double>(), "number"));
    }
    return Number::parse(py::str(object).cast<std::string>());
}

template <class Operation> auto binary(Operation operation) {
    return [operation](const Number& a, const Rational& b) { return to_python(operation(a, to_number(b))); };
}
template <class Operation> auto reversed(Operation operation) {
    return [operation](const Number& a, const Rational& b) { return to_python(operation(to_number(b), a)); };
}
template <class Relation> auto relation(Relation relation) {
    return [relation](const Number& a, const Rational& b) { return relation((a - to_number(b)).sign()); };
}

Number quotient(const Number& a, const Number& b) {
    if (b.is_zero()) {
        PyErr_SetString(PyExc_ZeroDivisionError, "division by an exact zero");
        throw py::error_already_set();
    }
    return a / b;
}

void bind_number(py::module_& module) {
    py::class_<Number>(module, "Number",
                       "A sum of rationals times square roots of integers, exact. Results that are rational are "
                       "fractions.Fraction.\n\nNumber(value): int, Fraction, Number, text such as \"1 + 1/2*sqrt(3)\", "
                       "or float, taken as the dyadic number that it stores.")
        .def(py::init([](const Rational& value) { return to_number(value); }), py::arg("value"))
        .def("__add__", binary(std::plus<>()))
        .def("__radd__", reversed(std::plus<>()))
        .def("__sub__", binary(std::minus<>()))
        .def("__rsub__", reversed(std::minus<>()))
        .def("__mul__", binary(std::multiplies<>()))
        .def("__rmul__", reversed(std::multiplies<>()))
        .def("__truediv__", binary(quotient))
        .def("__rtruediv__", reversed(quotient))
        .def("__neg__", [](const Number& a) { return to_python(-a); })
        .def("__abs__", [](const Number& a) { return to_python(a.sign() < 0 ? -a : a); })
        .def("__eq__",
             [](const Number& a, const py::object& b) -> py::object {
                 const py::object rational = py::module_::import("numbers").attr("Real");
                 const bool known = py::isinstance<Number>(b) || py::isinstance(b, rational);
                 return known ? py::cast(a == to_number(b))
                              : py::object(py::reinterpret_borrow<py::object>(Py_NotImplemented));
             })
        .def("__lt__", relation([](int sign) { return sign < 0; }))
        .def("__le__", relation([](int sign) { return sign <= 0; }))
        .def("__gt__", relation([](int sign) { return sign > 0; }))
        .def("__ge__", relation([](int sign) { return sign >= 0; }))
        .def("__bool__", [](const Number& a) { return !a.is_zero(); })
        .def("__hash__",
             [](const Number& a) { return a.is_rational() ? py::hash(to_python(a)) : py::hash(py::str(a.text())); })
        .def("__float__", &Number::to_double)
        .def("__str__", &Number::text)
        .def("__repr__", [](const Number& a) { return "Number('" + a.text() + "')"; })
        .def("__reduce__",
             [](const py::object& a) { return py::make_tuple(py::type::of(a), py::make_tuple(py::str(a))); })
        .def("enclosure", &Number::enclosure, "(value, radius) in doubles; the number lies within.");
    module.def(
        "sqrt", [](const Rational& value) { return to_python(exact::sqrt(to_number(value))); }, py::arg("rational"),
        "The exact root of a rational: Number or Fraction.");
}

using crafted::ExactPacking;
using Seen = crafted::Inspection;

/// An exact packing for Python; `contacts` is set for stored doubles, whose contacts are part of the state.
struct Crafted {
    ExactPacking packing;
    std::optional<std::vector<Contact>> contacts;
    std::string title;
    std::string text; ///< the text of the file, or of the state
};

struct CraftedInspection {
    ExactPacking packing;
    Seen seen;
};

std::vector<Contact> contacts_of(const Crafted& crafted) {
    return crafted.contacts ? *crafted.contacts
                            : value_or_raise(crafted::exact_contacts(crafted.packing), crafted.packing.dimension());
}

Crafted parsed(const std::string& text, const std::string& source) {
    crafted::PackingFile file = crafted::parse_packing(text, source);
    return {std::move(file.packing), std::nullopt, std::move(file.title), text};
}

Crafted read(const std::filesystem::path& path) {
    return parsed(read_text(path), path.string());
}

Crafted of_state(const PyState& state) {
    require_single_grains(state.state.packing, "State", "an exact packing");
    return {crafted::exact_copy(state.state.packing), state.state.contacts, "", state_text(state.state)};
}

CraftedInspection inspected(const Crafted& crafted) {
    if (crafted.contacts) {
        return {crafted.packing,
                interruptible([crafted] { return inspect_contacts(crafted.packing, *crafted.contacts); })};
    }
    return {crafted.packing, value_or_raise(interruptible([crafted] { return crafted::inspect(crafted.packing); }),
                                            crafted.packing.dimension())};
}

As<"list[dict[int, Exact]]"> exact_columns(const Crafted& crafted) {
    const auto contacts = contacts_of(crafted);
    const DofMap dofs(approximate(crafted.packing));
    const exact::NumberMatrix matrix = crafted::exact_contact_matrix(crafted.packing, dofs, contacts);
    py::list columns;
    for (const auto& column : matrix.column) {
        py::dict entries;
        for (const auto& [row, value] : column) {
            entries[py::int_(row)] = to_python(value);
        }
        columns.append(entries);
    }
    return columns;
}

As<"tuple[Exact, Exact]"> per_axis(const ExactPacking& packing, const PerAxis<Number>& numbers) {
    return py::tuple(to_python(std::vector<Number>(numbers.begin(), numbers.begin() + packing.dimension())));
}

void bind_crafted(py::module_& module) {
    py::class_<Crafted>(
        module, "ExactPacking",
        "A packing in exact numbers; its contacts are the pairs at gap exactly 0. Make one with `exact_packing`.")
        .def_static("read", &read, py::arg("path"), "Reads a packing file (TOML).")
        .def_static("parse", &parsed, py::arg("text"), py::arg("source") = "ExactPacking",
                    "The same from text; `source` begins messages.")
        .def_static("of_state", &of_state, py::arg("state"),
                    "The stored doubles of a State as exact numbers, with its contacts.")
        .def(py::pickle([](const Crafted& self) { return py::make_tuple(self.text, self.contacts.has_value()); },
                        [](const py::tuple& parts) {
                            const auto text = parts[0].cast<std::string>();
                            return parts[1].cast<bool>()
                                       ? of_state(parse_any_state(text, "ExactPacking", Dimensions::any))
                                       : parsed(text, "ExactPacking");
                        }))
        .def("__len__", [](const Crafted& self) { return self.packing.disk_count(); })
        .def_readonly("title", &Crafted::title, "Title of the file.")
        .def_property_readonly(
            "centres", [](const Crafted& self) -> As<"list[tuple[Exact, Exact]]"> {
                py::list rows;
                for (const auto& centre : self.packing.centre) {
                    rows.append(per_axis(self.packing, centre));
                }
                return rows;
            },
            "Rows (x, y), of spheres (x, y, z), exact; length.")
        .def_property_readonly(
            "radii", [](const Crafted& self) { return to_python(self.packing.radius); }, "Exact radii; length.")
        .def_property_readonly(
            "length", [](const Crafted& self) { return per_axis(self.packing, self.packing.length); },
            "(Lx, Ly), of spheres (Lx, Ly, Lz), exact; 0 where there is no wall.")
        .def_property_readonly(
            "packing", [](const Crafted& self) { return approximate(self.packing); },
            "The nearest doubles, as a Packing: for pictures.")
        .def_property_readonly(
            "contacts", [](const Crafted& self) { return contact_array(contacts_of(self)); },
            "(N, 2) contacts: every gap is decided. Raises Overlap.")
        .def("exact_columns", &exact_columns,
             "The contact matrix, exact: for each contact {degree of freedom: entry}; unit normals.")
        .def("inspect", &inspected,
             "ExactInspection. Raises Overlap. Meant for up to some 100 disks; beyond, rank and what needs no kernel.");
}

py::list enclosed(const std::vector<crafted::EnclosedVector>& vectors) {
    py::list list;
    for (const crafted::EnclosedVector& vector : vectors) {
        list.append(py::make_tuple(
            py::array_t<double>(static_cast<py::ssize_t>(vector.value.size()), vector.value.data()), vector.radius));
    }
    return list;
}

As<"tuple[Verdict, list[tuple[Floats, float]], list[tuple[Floats, float]]]">
enclosed_bases(const CraftedInspection& self, int count) {
    const auto bases = unlocked([&] { return crafted::enclose_bases(self.packing, self.seen, count); });
    return py::make_tuple(bases.verdict, enclosed(bases.self_stresses), enclosed(bases.motions));
}

using InspectionClass = py::class_<CraftedInspection>;

/// Returns a member of the inspection.
template <class Member> auto field(Member member) {
    return [member](const CraftedInspection& self) { return self.seen.*member; };
}

/// Returns a member of exact numbers.
template <class Member> auto exact(Member member) {
    return [member](const CraftedInspection& self) { return to_python(self.seen.*member); };
}

void bind_counts(InspectionClass& inspection) {
    using Self = CraftedInspection;
    inspection.def_property_readonly("dofs", field(&Seen::dof_count), "N_f.")
        .def_property_readonly(
            "contacts", [](const Self& self) { return contact_array(self.seen.contacts); }, "(N, 2) contacts.")
        .def_property_readonly("rank", field(&Seen::rank),
                               "Proved lower bound of the rank; the rank where `rank_exact` is proved.")
        .def_property_readonly("rank_exact", field(&Seen::rank_exact), "Verdict on: `rank` is the rank.")
        .def_property_readonly("h", field(&Seen::hyperstaticity), "N - rank: self-stresses.")
        .def_property_readonly("k", field(&Seen::mechanisms), "N_f - rank: mechanisms, rigid motions included.")
        .def_property_readonly("rigid_motions", field(&Seen::rigid_motions),
                               "Of the whole packing: 3 for a free cluster, 0 in a box.")
        .def_property_readonly("generic_rank", field(&Seen::generic_rank),
                               "Proved lower bound of the rank for random coordinates with the same contacts.")
        .def_property_readonly("special_position", field(&Seen::special_position),
                               "Verdict on: the rank is below the generic one.")
        .def_property_readonly(
            "verdict", [](const Self& self) { return self.seen.verdict(); },
            "\"isostatic\", \"hyperstatic\", \"hypostatic\", \"hyperstatic and hypostatic\" or \"undecided\".")
        .def_property_readonly(
            "strains", [](const Self& self) -> As<"dict[str, Counting]"> {
                py::dict out;
                for (std::size_t s = 0; self.seen.strains && s < strains.size(); ++s) {
                    out[to_string(strains[s])] = (*self.seen.strains)[s];
                }
                return out;
            },
            "Of a cell: a Counting for \"fixed cell\", \"isotropic\", \"diagonal\", \"full strain\"; else empty.");
}

void bind_bases(InspectionClass& inspection) {
    using Self = CraftedInspection;
    inspection
        .def_property_readonly("bases_exact", field(&Seen::bases_exact),
                               "Verdict on: both bases are complete and verified.")
        .def_property_readonly("self_stresses", exact(&Seen::self_stresses), "Basis: h lists of N exact forces.")
        .def_property_readonly("mechanisms", exact(&Seen::motions), "Basis: k lists of N_f exact velocities.")
        .def_property_readonly(
            "one_sign",
            [](const Self& self) {
                return self.seen.one_sign_decided ? crafted::to_string(self.seen.one_sign.kind) : "undecided";
            },
            "Self-stresses of one sign: \"strict\", \"partial\", \"none\", \"undecided\".")
        .def_property_readonly(
            "hold",
            [](const Self& self) {
                std::vector<std::string> words;
                for (const crafted::DiskHold hold : self.seen.hold) {
                    words.emplace_back(crafted::to_string(hold));
                }
                return words;
            },
            "Per disk: \"held\", \"bridge\", \"rattler\", \"fixed\", \"loaded\", \"member\" of a body.");
}

void bind_equilibrium(InspectionClass& inspection) {
    using Self = CraftedInspection;
    inspection
        .def_property_readonly(
            "support", [](const Self& self) { return crafted::to_string(self.seen.support); },
            "What the load meets: \"positive\", \"with zeros\", \"none\", \"unbalanced\", \"undecided\", \"no load\".")
        .def_property_readonly("forces", exact(&Seen::forces),
                               "One equilibrium: N exact forces; empty where there is none.")
        .def_property_readonly("forces_unique", field(&Seen::forces_unique), "h = 0 and the load is balanced.")
        .def_property_readonly("without_force", field(&Seen::without_force),
                               "Disks that can move and carry no force of the load.")
        .def_property_readonly(
            "second_order", [](const Self& self) { return crafted::to_string(self.seen.second_order); },
            "Contacts as bars: \"no mechanism\", \"rigid\", \"flexes\", \"undecided\".")
        .def_property_readonly("stable", field(&Seen::stable),
                               "Verdict on: a local minimum of the potential, strict up to rigid motions.")
        .def_property_readonly(
            "jammed",
            [](const Self& self) {
                std::map<std::string, Verdict> out;
                if (self.seen.jamming) {
                    out["collectively"] = self.seen.jamming->collective;
                    if (self.seen.jamming->strict) {
                        out["strictly"] = *self.seen.jamming->strict;
                    }
                }
                return out;
            },
            "Of a cell, or of walls that all stay (\"collectively\" alone): a Verdict for \"collectively\" and "
            "\"strictly\", of the disks that are not rattlers; else "
            "empty.");
}

void bind_crafted_inspection(py::module_& module) {
    InspectionClass inspection(
        module, "ExactInspection",
        "What is proved of a crafted packing, in exact arithmetic. str() gives lines for a terminal.");
    bind_counts(inspection);
    bind_bases(inspection);
    bind_equilibrium(inspection);
    inspection
        .def("enclosed_bases", &enclosed_bases, py::arg("count") = 1,
             "(verdict, self_stresses, mechanisms) in doubles, the first `count` of each: pairs (array, radius), every "
             "component within the radius. For packings that are too large for exact bases.")
        .def("__str__", [](const CraftedInspection& self) { return crafted::to_text(self.seen, self.packing); });
}

using crafted::Genericity, crafted::GenericitySample;

Genericity made_generic(const Packing& packing, const std::vector<Contact>& contacts, double size, int samples,
                        std::uint64_t seed, double stress, bool keep_equal, bool tilt) {
    crafted::GenericityOptions options;
    options.size = finite(size, "size");
    options.samples = samples;
    options.seed = seed;
    options.stress = finite(stress, "stress");
    options.keep_equal = keep_equal;
    options.tilt = tilt;
    return interruptible([packing, contacts, options] { return crafted::genericity(packing, contacts, options); });
}

template <class What, class Parts> void bind_genericity_of(py::module_& module, Parts parts) {
    module.def(
        "genericity",
        [parts](const What& what, double size, int samples, std::uint64_t seed, double stress, bool keep_equal,
                bool tilt) {
            const auto [packing, contacts] = parts(what);
            return made_generic(packing, contacts, size, samples, seed, stress, keep_equal, tilt);
        },
        py::arg("packing"), py::kw_only(), py::arg("size") = 1e-6, py::arg("samples") = 100, py::arg("seed") = 1,
        py::arg("stress") = 1.0, py::arg("keep_equal") = false, py::arg("tilt") = false,
        "Genericity of an ExactPacking or a State: each radius times 1 + size u, u uniform in [-1, 1), `samples` "
        "times; are the copies isostatic? Members of clumps move too, by their radii times size u. `keep_equal`: equal "
        "radii stay equal, members in their places; `tilt`: that of a cell changes too. "
        "As `isostat genericity`.");
}

void bind_genericity(py::module_& module) {
    py::class_<Genericity>(module, "Genericity", "What became of perturbed copies: see `genericity`.")
        .def_property_readonly(
            "samples", [](const Genericity& self) -> As<"list[dict[str, object]]"> {
                py::list rows;
                for (const GenericitySample& s : self.samples) {
                    using namespace py::literals;
                    rows.append(py::dict(
                        "seed"_a = s.seed, "failure"_a = s.failure ? to_string(s.failure->kind) : nullptr,
                        "contacts"_a = contact_array(s.contacts), "carrying"_a = contact_array(s.carrying),
                        "rattlers"_a = s.rattlers, "turns"_a = s.turns, "min_force"_a = s.min_force,
                        "min_gap"_a = s.min_gap, "sigma_min"_a = s.sigma_min, "within_original"_a = s.within_original));
                }
                return rows;
            },
            "Of each copy a dictionary: `seed`; `failure`, a word, or None where h = k = 0 is proved; `contacts`, "
            "those "
            "`carrying` force, `rattlers`, `turns` of rotational rattlers (clumps); proved lower bounds `min_force`, "
            "`min_gap`, `sigma_min`; `within_original`.")
        .def_readonly("proved", &Genericity::proved, "Copies with h = k = 0, proved.")
        .def_readonly("ties", &Genericity::ties, "Copies that tie.")
        .def_readonly("undecided", &Genericity::undecided, "Copies of which nothing is proved.")
        .def_readonly("failed", &Genericity::failed, "Copies without a vertex.")
        .def_property_readonly("within", &Genericity::within, "Copies whose force network is part of the contacts.")
        .def_property_readonly(
            "networks", [](const Genericity& self) { return self.lists.size(); }, "Different force networks.");
    bind_genericity_of<Crafted>(
        module, [](const Crafted& what) { return std::pair(approximate(what.packing), contacts_of(what)); });
    bind_genericity_of<PyState>(module,
                                [](const PyState& what) { return std::pair(what.state.packing, what.state.contacts); });
}

} // namespace

void bind_exact(py::module_& module) {
    bind_number(module);
    bind_crafted_inspection(module);
    bind_crafted(module);
    bind_genericity(module);
}

} // namespace isostat::python
