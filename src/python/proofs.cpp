// Binds inspect, certify, verify: proofs for one state, and for a run.
#include "certificate/jammed_box.hpp"
#include "convert.hpp"
#include "core/refuse.hpp"
#include "io/files.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>
#include <isostat/io/state_file.hpp>

#include <map>

namespace isostat::python {

namespace {

/// A certificate, with the verdict and the refuted claims, which are not in its file.
struct Certified {
    Certificate certificate;
    Verdict verdict = Verdict::undecided;
    std::vector<std::string> refuted;
};

Certified certified(Certificate certificate) {
    certificate.program = "isostat " ISOSTAT_VERSION;
    Certification result = certify(certificate.state);
    certificate.claims = std::move(result.claims);
    return {std::move(certificate), result.verdict, std::move(result.refuted)};
}

Certified certify_file(const std::filesystem::path& path) {
    Certificate certificate;
    certificate.input = path.filename().string();
    certificate.input_hash = sha256(read_text(path));
    certificate.state = with_free_motions_held(read_any_state(path, Dimensions::any_bodies).state);
    return certified(std::move(certificate));
}

Certified certify_state(const PyState& state) {
    Certificate certificate;
    certificate.input = "State";
    certificate.input_hash = sha256(state_text(state.state));
    certificate.state = with_free_motions_held(state.state);
    return certified(std::move(certificate));
}

/// One property of the claims: `get` of the claim if it exists, else None.
template <class Claim, class Get> auto claim(std::optional<Claim> CertificateClaims::*member, Get get) {
    return [member, get](const Certified& self) {
        const auto& there = self.certificate.claims.*member;
        return there ? std::optional(get(*there)) : std::nullopt;
    };
}

using LoadEnd = As<"Optional[tuple[tuple[float, float], Pair]]">;

/// An end of the supported interval; None where it is unbounded or not proved.
auto load_end(LoadEndClaim LoadIntervalClaim::*member) {
    return [member](const Certified& self) -> LoadEnd {
        const auto& there = self.certificate.claims.load_interval;
        return there && !((*there).*member).unbounded
                   ? py::object(py::make_tuple(((*there).*member).stress, ((*there).*member).opens))
                   : py::object(py::none());
    };
}

using CertificateClass = py::class_<Certified>;

void bind_claims(CertificateClass& certificate) {
    using Claims = CertificateClaims;
    certificate
        .def_property_readonly("counting",
                               claim(&Claims::counting,
                                     [](const CountingClaim& c) {
                                         py::dict dict;
                                         dict["dofs"] = c.dof_count;
                                         dict["contacts"] = c.contact_count;
                                         dict["rank"] = c.rank;
                                         dict["h"] = c.hyperstaticity;
                                         dict["k"] = c.hypostaticity;
                                         return As<"dict[str, int]">(dict);
                                     }),
                               "{\"dofs\", \"contacts\", \"rank\", \"h\", \"k\"}, exact; None.")
        .def_property_readonly(
            "vertex", claim(&Claims::vertex, [](const VertexClaim& c) { return std::pair(c.radius, c.unique_radius); }),
            "(radius, unique_radius): a true vertex lies within `radius` of the stored coordinates, no other one "
            "within `unique_radius`; length. None.")
        .def_property_readonly(
            "forces", claim(&Claims::forces, [](const ForcesClaim& c) { return interval_array(c.finite); }),
            "(N, 2) ends of the intervals that hold the forces at the true vertex; stress x length. None.")
        .def_property_readonly("structural_zeros",
                               claim(&Claims::forces, [](const ForcesClaim& c) { return c.structural_zeros; }),
                               "Places of contacts whose force is exactly 0 for combinatorial reasons; None.")
        .def_property_readonly(
            "infinitesimal_forces",
            claim(&Claims::forces, [](const ForcesClaim& c) { return interval_array(c.infinitesimal); }),
            "(z, 2) ends of intervals of the infinitesimal forces in the structural zeros; None.")
        .def_property_readonly("smallest_gap",
                               claim(&Claims::gaps, [](const GapsClaim& c) { return std::pair(c.smallest, c.where); }),
                               "(gap, contact): every other pair has at least this gap; where. None.")
        .def_property_readonly(
            "low", load_end(&LoadIntervalClaim::low),
            "((lower, upper), contact): lower end of the supported interval of the loaded stress, enclosed, and what "
            "opens there. None: unbounded or not proved.")
        .def_property_readonly("high", load_end(&LoadIntervalClaim::high),
                               "((lower, upper), contact): upper end. None: unbounded or not proved.")
        .def_property_readonly(
            "minimum", claim(&Claims::minimum, [](const MinimumClaim& c) { return std::pair(c.away, c.curvature); }),
            "(away, curvature), of clumps with mechanisms that the load reaches, in the place of the other claims: no "
            "coordinate is farther than `away` from an equilibrium that is a strict local minimum, where the second "
            "variation on the held coordinates is at least `curvature`. None.")
        .def_property_readonly(
            "form",
            claim(&Claims::minimum, [](const MinimumClaim& c) { return std::pair(c.held, interval_array(c.form)); }),
            "(held, (m, 2) ends of intervals) of `minimum`: the held coordinates that the load reaches, and the second "
            "variation on them at their stored values, rows of the upper triangle. None.");
}

void bind_certificate(py::module_& module) {
    CertificateClass certificate(
        module, "Certificate",
        "What is proved of a state, for `verify`. A claim that was not proved is None; `undecided` says why.");
    certificate
        .def_readonly(
            "verdict", &Certified::verdict,
            "Verdict on: the true vertex is an isostatic, stable equilibrium without overlap; with `minimum`, that the "
            "equilibrium which it names is one.")
        .def_readonly("refuted", &Certified::refuted, "Sentences: claims that are proved to be wrong.")
        .def_property_readonly(
            "undecided", [](const Certified& self) { return self.certificate.claims.undecided; },
            "Sentences: one per claim that is absent.")
        .def_property_readonly(
            "state",
            [](const Certified& self) {
                return PyState{self.certificate.state, {}};
            },
            "The state it speaks of.");
    bind_claims(certificate);
    certificate
        .def_property_readonly(
            "stable", [](const Certified& self) { return self.certificate.claims.stable; },
            "True: claimed a strict local minimum of the potential. False: no claim.")
        .def(
            "text", [](const Certified& self) { return certificate_text(self.certificate); },
            "The JSON text of the certificate file.")
        .def(
            "write",
            [](const Certified& self, const std::filesystem::path& path) { write_certificate(path, self.certificate); },
            py::arg("path"), "Writes the certificate file in one step. Raises CannotWrite.");
    constexpr const char* words_of_certify =
        "Certificate of a State or of a state file. Cost: about one factorisation of the contact matrix more "
        "than an inspection.";
    module.def(
        "certify",
        [](const std::filesystem::path& file) { return interruptible([file] { return certify_file(file); }); },
        py::arg("file"), words_of_certify);
    module.def(
        "certify", [](const PyState& state) { return interruptible([state] { return certify_state(state); }); },
        py::arg("state"), words_of_certify);
}

void bind_inspect(py::module_& module) {
    module.def(
        "inspect",
        [](const PyState& state) {
            return value_or_raise(
                interruptible([state] { return inspect_vertex(with_free_motions_held(state.state)); }),
                state.state.packing.dimension);
        },
        py::arg("state"),
        "Inspection of a State: rank, forces, supported interval, gaps, stability. Raises NotIsostatic when h > 0 or "
        "the rank is not proved, Undecided when no bound was proved.");
}

std::vector<Enclosure> length_rates(const Inspection& inspection) {
    const auto axes = inspection.yielding ? inspection.truth.dimension : 0;
    const PerAxis<Enclosure> all = inspection.yielding ? inspection.yielding->length_rate : PerAxis<Enclosure>{};
    return {all.begin(), all.begin() + axes};
}

using BoundInspection = py::class_<Inspection, std::shared_ptr<Inspection>>;

/// A member of its record.
template <class Member> auto of_record(Member member) {
    return [member](const Inspection& self) { return self.record.*member; };
}

void bind_record(BoundInspection& inspection) {
    using Record = EquilibriumRecord;
    inspection.def_property_readonly("sigma2", of_record(&Record::stress), "Loaded stress.")
        .def_property_readonly(
            "sigma2_low", of_record(&Record::stress_low),
            "Lower end of the supported interval of the loaded stress; -inf: unbounded; nan: not decided.")
        .def_property_readonly("sigma2_high", of_record(&Record::stress_high),
                               "Upper end; inf: unbounded; nan: not decided.")
        .def_property_readonly("opens_low", of_record(&Record::opens_low),
                               "Contact whose force vanishes at `sigma2_low`; None.")
        .def_property_readonly("opens_high", of_record(&Record::opens_high),
                               "Contact whose force vanishes at `sigma2_high`; None.")
        .def_property_readonly("force_bound", of_record(&Record::force_bound),
                               "Proved bound of the error of every force.")
        .def_property_readonly("min_gap", of_record(&Record::min_gap),
                               "Lower bound of the gaps of all other pairs; length.")
        .def_property_readonly("sigma_min_bound", of_record(&Record::sigma_min_bound),
                               "Proved lower bound of the smallest singular value of the contact matrix.")
        .def_property_readonly("strain", of_record(&Record::strain), "[eps_1, eps_2], positive in compression.")
        .def_property_readonly("potential", of_record(&Record::potential), "W = -sum F q.")
        .def_property_readonly("decided_by", of_record(&Record::decided_by),
                               "The arithmetic that settled it: \"double\", \"double-double\", \"mpfr\", \"exact\".");
}

void bind_inspection(py::module_& module) {
    using Seen = Inspection;
    using Record = EquilibriumRecord;
    BoundInspection inspection(
        module, "Inspection",
        "What is known of a state without moving it; forces and ends of intervals are middles of proved intervals.");
    inspection.def_readonly("counting", &Seen::counting, "Counting: N_f, N, rank, h, k.")
        .def_property_readonly(
            "contacts", [](const Seen& self) { return contact_array(self.contacts); },
            "(N, 2) contacts of the state, then coordinates that had to be held.")
        .def_property_readonly("forces", vector_of(&Seen::forces),
                               "(N,) forces, one per row of `contacts`; stress x length, positive in compression.")
        .def_property_readonly(
            "force_intervals", [](const Seen& self) { return interval_array(self.truth.finite); },
            "(N, 2) proved intervals of the forces at the true vertex; (0, 2) without one.")
        .def_property_readonly("structural_zero", vector_of(&Seen::structural_zero),
                               "(N,) 1: the force is exactly 0 for every load on the walls.")
        .def_property_readonly("rattlers", vector_of(&Seen::rattlers),
                               "Numbers of the disks without a force-carrying contact; of clumps of all their members.")
        .def_property_readonly("rotational_rattlers", vector_of(&Seen::rotational_rattlers),
                               "First members of clumps that turn about the one member with contacts.")
        .def_property_readonly("verdict", of_record(&Record::verdict),
                               "Verdict on: an isostatic equilibrium without overlap.")
        .def_readonly("stable", &Seen::stable,
                      "Verdict on: a strict local minimum of the potential. Refuted: a maximum along the mechanism.")
        .def_readonly("second_order", &Seen::second_order,
                      "(value, bound): second derivative of the potential along the mechanism (k = 1).")
        .def_property_readonly(
            "length_rates", &length_rates,
            "(value, bound) per axis: change of the length per unit of the loaded stress, where the potential has a "
            "minimum along mechanisms; else empty.")
        .def_property_readonly(
            "second_variation",
            [](const Seen& self) { return self.yielding ? self.yielding->second_variation : std::vector<Enclosure>(); },
            "(value, bound) of the eigenvalues of the second variation at that minimum on the mechanisms that the load "
            "reaches, in (X, Y, angle) and lengths; X, Y: mean of the centres of the members.")
        .def_readonly("remark", &Seen::remark, "Where it is no equilibrium: which contact, and by how much.");
    bind_record(inspection);
    bind_inspect(module);
}

/// The jamming of a cell or of a box.
struct Jamming {
    std::map<std::string, Verdict> verdicts;
    std::map<std::string, std::string> reasons;
    std::map<std::string, JammedIfClosed> if_closed;
    std::map<std::string, Counting> counts, backbone;
    int grains = 0;

    void add(const std::string& what, const JammingAnswer& answer) {
        verdicts[what] = answer.verdict;
        reasons[what] = answer.reason;
        if (answer.if_closed) {
            if_closed[what] = *answer.if_closed;
        }
    }
};

Jamming jamming_of(const State& state) {
    require_single_grains(state.packing, "State", "jamming");
    Jamming out;
    const Certification truth = certify(state);
    if (state.packing.cell.all()) {
        const CellInspection cell = inspect_cell(state, truth);
        out.add("local", cell.local);
        out.add("collective", cell.collective);
        out.add("strict", cell.strict);
        for (std::size_t s = 0; s < strains.size(); ++s) {
            out.counts[to_string(strains[s])] = cell.all[s];
            if (cell.backbone) {
                out.backbone[to_string(strains[s])] = (*cell.backbone)[s];
            }
        }
        out.grains = cell.backbone_disks;
    } else if (const auto box = inspect_box(state, truth)) {
        out.add("collective", box->collective);
        out.counts["box"] = out.backbone["box"] = box->counting;
        out.grains = box->grains;
    } else {
        refuse("jamming", "expected a cell that is periodic along every axis, or a box with all its walls, no grain "
                          "fixed and no force on a grain");
    }
    return out;
}

void bind_jamming(py::module_& module) {
    py::class_<JammedIfClosed>(module, "JammedIfClosed",
                               "Of every packing near the stored one in which all contacts of its list close, whatever "
                               "the radii; whether there is such a packing is not asked.")
        .def_readonly("verdict", &JammedIfClosed::verdict,
                      "PROVED: each is jammed; REFUTED: each in which no other pair touches is not.")
        .def_readonly("contacts", &JammedIfClosed::contacts, "How many, without those of rattlers by coordination.")
        .def_readonly("within", &JammedIfClosed::within,
                      "How near: the 2-norm of the change of coordinates and cell or box.");
    py::class_<Jamming>(module, "Jamming", "What is jammed, and counts: see `jamming`.")
        .def_readonly("verdicts", &Jamming::verdicts,
                      "A Verdict for \"local\", \"collective\" and \"strict\", of a box for \"collective\": of "
                      "the grains that carry a force, while walls stay.")
        .def_readonly("reasons", &Jamming::reasons, "Why, in words.")
        .def_readonly("if_closed", &Jamming::if_closed,
                      "Of answers that are undecided, where it is known: a JammedIfClosed.")
        .def_readonly("counts", &Jamming::counts,
                      "A Counting for \"fixed cell\", \"isotropic\", \"diagonal\", \"full strain\"; \"box\" "
                      "without rattlers.")
        .def_readonly("backbone", &Jamming::backbone,
                      "The same without rattlers; empty where the forces are not known.")
        .def_readonly("grains", &Jamming::grains, "Grains of the backbone; in a box those that are no rattlers.");
    module.def(
        "jamming",
        [](const PyState& state) {
            const State copy = state.state;
            return interruptible([copy] { return jamming_of(copy); });
        },
        py::arg("state"),
        "Jamming of a periodic cell or of a box, each answer proved, refuted or undecided. Needs an equilibrium that "
        "is "
        "proved.");
}

void bind_forces(py::module_& module) {
    module.def(
        "forces_at",
        [](const PyState& state, double sigma) {
            const State copy = with_free_motions_held(state.state);
            finite(sigma, "sigma2");
            return interval_array(value_or_raise(interruptible([copy, sigma] { return forces_at(copy, sigma); }),
                                                 copy.packing.dimension));
        },
        py::arg("state"), py::arg("sigma2"),
        "(N, 2) ends of the intervals that hold the forces at the true vertex under the loaded stress `sigma2` instead "
        "of the state's own; stress x length. Outside of the supported interval some are negative: then no equilibrium "
        "has them. Raises NotIsostatic or Undecided.");
}

RunVerification verify_folder(const std::filesystem::path& folder,
                              const As<"Optional[Callable[[int, int], None]]">& progress) {
    const py::gil_scoped_release release;
    return verify_run(folder, [&progress](const VerificationProgress& at) {
        check_signals();
        if (!progress.is_none()) {
            const py::gil_scoped_acquire acquire;
            progress(at.arcs + at.equilibria, at.all_arcs + at.all_equilibria);
        }
    });
}

void bind_verification(py::module_& module) {
    py::class_<ClaimCheck>(module, "ClaimCheck", "The answer of the checker to one claim.")
        .def_readonly("claim", &ClaimCheck::claim, "Its name.")
        .def_readonly("claimed", &ClaimCheck::claimed, "False: the certificate does not claim it.")
        .def_readonly("verdict", &ClaimCheck::verdict, "Verdict on the claim.")
        .def_readonly("detail", &ClaimCheck::detail, "One line: what was proved, or why not.")
        .def_property_readonly(
            "numbers", [](const ClaimCheck& self) -> As<"dict[str, float]"> {
                py::dict dict;
                for (const auto& [name, value] : self.numbers) {
                    dict[py::str(name)] = value;
                }
                return dict;
            },
            "The numbers behind it, rounded outwards.");
    py::class_<Verification>(module, "Verification", "The answers of the checker to a certificate.")
        .def_readonly("verdict", &Verification::verdict,
                      "Refuted: a claim is; undecided: one is undecided or absent; else proved.")
        .def_readonly("checks", &Verification::checks, "ClaimCheck of each claim.");
    using Run = RunVerification;
    py::class_<Run>(module, "RunVerification", "What became of the records of a run.")
        .def_readonly(
            "verdict", &Run::verdict,
            "Proved: every equilibrium and both ends of every arc; the ways between them only at level `arcs`: see "
            "`words`.")
        .def_property_readonly(
            "words", [](const Run& self) { return words(self); }, "The answer in words.")
        .def_readonly("finished", &Run::finished, "False: the run goes on, or was killed; nothing else was looked at.")
        .def_readonly("wrong", &Run::wrong, "The first record that is wrong: file, record, what.")
        .def_readonly("undecided", &Run::undecided, "What could not be checked.")
        .def_readonly("arcs", &Run::arcs, "Records of arcs.")
        .def_readonly("arcs_proved", &Run::arcs_proved, "Arcs whose ends were proved.")
        .def_readonly("ways_proved", &Run::ways_proved, "Arcs whose way was proved.")
        .def_readonly("equilibria", &Run::equilibria, "Rows of equilibria.csv.")
        .def_readonly("equilibria_proved", &Run::equilibria_proved, "Rows proved.");
    module.def(
        "_verify_certificate",
        [](const Certified& certified) { return interruptible([certified] { return verify(certified.certificate); }); },
        py::arg("certificate"));
    module.def(
        "_verify_file",
        [](const std::filesystem::path& path) {
            return interruptible([path] { return verify(read_certificate(path)); });
        },
        py::arg("path"));
    module.def("_verify_folder", &verify_folder, py::arg("folder"), py::arg("progress"));
}

} // namespace

void bind_proofs(py::module_& module) {
    bind_certificate(module);
    bind_inspection(module);
    bind_jamming(module);
    bind_forces(module);
    bind_verification(module);
}

} // namespace isostat::python
