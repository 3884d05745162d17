#include "contact/gap_sign.hpp"
#include "verified/exact_forces.hpp"
#include "verified/norm.hpp"
#include "verified/real.hpp"
#include "verified/refined_vertex.hpp"
#include "verified/refinement.hpp"
#include "verified/vertex_bounds.hpp"

#include <isostat/core/work.hpp>
#include <isostat/verified/force_ladder.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;
constexpr mpfr_prec_t low_bits = 160; ///< of comparisons on the rungs double and double-double, and of exact roots

bool all_zero(const std::vector<double>& x) {
    return std::all_of(x.begin(), x.end(), [](double c) { return c == 0; });
}

/// Rational times the root of an integer, to `bits` bits (a few units of rounding).
Real root_product(const mpq_class& factor, const mpz_class& square, mpfr_prec_t bits) {
    Real root(bits + 8);
    mpfr_set_z(root.get(), square.get_mpz_t(), MPFR_RNDN);
    mpfr_sqrt(root.get(), root.get(), MPFR_RNDN);
    Real result(bits + 8);
    mpfr_set_q(result.get(), factor.get_mpq_t(), MPFR_RNDN);
    mpfr_mul(result.get(), result.get(), root.get(), MPFR_RNDN);
    return result;
}

/// One right-hand side with what is known of its solution on every rung reached.
struct Part {
    std::vector<double> force;
    LoadTerms terms;
    bool zero = false;
    bool rough = false;        ///< `solution` stopped at `first_accuracy`
    std::vector<double> guess; ///< of the solution, or empty
    ForceSolution solution;    ///< on the rung `solution.rung` with `solution.bits`; empty before the first request
    RefinedVector refined;     ///< rung multiprecision
    std::vector<mpq_class> unknown; ///< rung exact
};

/// Rounds a vector of MPFR numbers to value + low, the rounding included in the bound.
void round(const std::vector<Real>& x, const Real& error, ForceSolution& solution) {
    const std::size_t n = x.size();
    solution.value.resize(n);
    solution.low.resize(n);
    Real bound(64);
    Real rest(64);
    for (std::size_t l = 0; l < n; ++l) {
        Real left = x[l];
        solution.value[l] = left.nearest();
        mpfr_sub_d(left.get(), left.get(), solution.value[l], MPFR_RNDN); // exact: cancels the leading bits
        solution.low[l] = left.nearest();
        mpfr_sub_d(left.get(), left.get(), solution.low[l], MPFR_RNDN);
        if (mpfr_number_p(left.get()) == 0) { // beyond the range of double
            solution.bound = std::numeric_limits<double>::infinity();
            return;
        }
        mpfr_abs(rest.get(), left.get(), MPFR_RNDU);
        mpfr_max(bound.get(), bound.get(), rest.get(), MPFR_RNDU);
    }
    mpfr_add(bound.get(), bound.get(), error.get(), MPFR_RNDU);
    solution.bound = bound.above();
}

/// What is said of forces in records holds to this fraction of the largest.
constexpr double recorded_accuracy = 1e-7;

double largest_of(const std::vector<double>& x) {
    double largest = 0;
    for (const double c : x) {
        largest = std::max(largest, std::abs(c));
    }
    return largest;
}

} // namespace

template <int Dim> struct ForceLadder<Dim>::Implementation {
    const Packing<Dim>* packing;
    const IsostaticStructure<Dim>* structure;
    const Factorisation* factorisation;
    const InverseBound* inverse;
    LadderOptions options;
    const VertexEnclosure* vertex; ///< null: the stored configuration is meant
    /// Of the configuration at which the present rung evaluates the normals: distance from the stored one, bound of
    /// |H* - H| there, and distance of the stored from the true one.
    struct Place {
        double shift = 0;
        double uncertainty = 0;
        double away = 0;
    };
    mutable std::optional<Place> place;
    mutable std::optional<double> rate; ///< normal_rate
    std::optional<RefinedVertex> refined_vertex;
    Rung rung = Rung::double_bound;
    int bits = 53;
    bool rough = false; ///< on the rung double: solutions at `first_accuracy` are enough
    bool exact_allowed = true;
    mutable std::vector<Part> parts;
    std::optional<ExtendedMatrix> extended;
    std::optional<RefinedSystem<Dim>> system;
    std::optional<ExactForces<Dim>> exact;
    /// By contact: the norm of the mechanism on the present rung.
    mutable std::map<std::size_t, PreciseInterval> mechanism;
    mutable std::map<std::size_t, mpq_class> mechanism_square;

    void bring(Part& part) const;
    [[nodiscard]] PreciseInterval evaluate(const ForceExpression& e) const;
    [[nodiscard]] PreciseInterval component(int part, std::size_t l) const;
    [[nodiscard]] PreciseInterval mechanism_norm(std::size_t l) const;
    /// A number with the sign of the expression, and the square of the expression: only on the rung exact.
    [[nodiscard]] mpq_class exact_value(const ForceExpression& e, mpq_class& square) const;
    bool open_exact();
    [[nodiscard]] bool converged() const;
    [[nodiscard]] const Place& where() const;
    [[nodiscard]] double normals() const;
    [[nodiscard]] double stored_uncertainty() const;
    void inflate(const Part& part, ForceSolution& s) const;
    bool extend();
    bool refine(int next);
};

template <int Dim> double ForceLadder<Dim>::Implementation::normals() const {
    if (!rate) {
        rate = vertex == nullptr       ? 0
               : vertex->lipschitz > 0 ? normal_rate(vertex->lipschitz)
                                       : normal_rate(*packing, structure->contacts());
    }
    return *rate;
}

template <int Dim>
const typename ForceLadder<Dim>::Implementation::Place& ForceLadder<Dim>::Implementation::where() const {
    if (!place) { // the rung double: normals of the stored configuration
        place.emplace();
        if (vertex != nullptr) {
            place->away = vertex->verdict == Verdict::proved
                              ? (vertex->radius + norm_above(vertex->correction)) * (1 + 4 * u)
                              : std::numeric_limits<double>::infinity();
            place->uncertainty = stored_uncertainty();
        }
    }
    return *place;
}

template <int Dim> double ForceLadder<Dim>::Implementation::stored_uncertainty() const {
    return normals() * where().away;
}

/// The bound of a solution at the place of the rung becomes one for the true vertex: |H*^-1| <= 1 / (sigma - |H* - H|),
/// |H* x - F*| <= |H x - F| + |(H* - H) x| + |F* - F|.
template <int Dim> void ForceLadder<Dim>::Implementation::inflate(const Part& part, ForceSolution& s) const {
    if (vertex == nullptr) {
        return;
    }
    const Place& here = where();
    const double sigma = inverse->sigma_min;
    const double left = (sigma - normals() * here.shift - here.uncertainty) * (1 - 8 * u);
    if (!(left > sigma / 2)) {
        s.bound = std::numeric_limits<double>::infinity();
        return;
    }
    double turned = here.uncertainty * norm_above(s.value) * (1 + 4 * u); // bound of |(H* - H) x|
    if (rung == Rung::double_bound) {
        turned = std::min(turned, turn_of_forces(*packing, structure->contacts(), s.value) * here.away);
    }
    const double residual = s.bound * sigma + turned + part.terms.rate * here.away;
    s.bound = residual / left * (1 + 16 * u);
}

/// Normals in double-double, at the vertex in double-double when the true one is meant.
template <int Dim> bool ForceLadder<Dim>::Implementation::extend() {
    VertexEnclosure at;
    if (vertex != nullptr) {
        at = enclose_vertex_double_double(*packing, *structure, *factorisation, *inverse);
        if (at.verdict != Verdict::proved) {
            return false;
        }
        const double shift = norm_above(at.correction);
        Place here;
        here.shift = shift;
        here.away = (shift + at.radius) * (1 + 4 * u);
        here.uncertainty = normals() * (at.radius + 0x1p-90 * shift);
        place = here;
    }
    extended = extended_contact_matrix(*packing, *structure, at.correction);
    count_work(Work::double_double);
    rung = Rung::double_double;
    bits = 106;
    return true;
}

/// The system in MPFR, at the vertex to as many bits when the true one is meant.
template <int Dim> bool ForceLadder<Dim>::Implementation::refine(int next) {
    const std::vector<Real> stored = exact_coordinates(packing->q, {});
    double sigma = inverse->sigma_min;
    Real uncertainty(64);
    if (vertex != nullptr) {
        RefinedVertex found = refine_vertex(*packing, *structure, *factorisation, *inverse,
                                            refined_vertex ? refined_vertex->coordinate : stored, next);
        if (found.verdict != Verdict::proved) {
            return false;
        }
        Place here;
        here.shift = found.shift;
        here.away = (found.shift + found.radius.above()) * (1 + 4 * u);
        mpfr_mul_d(uncertainty.get(), found.radius.get(), normals(), MPFR_RNDU); // may be far below the range of double
        sigma = (sigma - normals() * here.shift - uncertainty.above()) * (1 - 8 * u);
        if (!(sigma > 0)) {
            return false;
        }
        here.uncertainty = uncertainty.above();
        place = here;
        refined_vertex = std::move(found);
    }
    system.emplace(*structure, vertex != nullptr ? refined_vertex->coordinate : stored, *factorisation, sigma,
                   uncertainty, next);
    count_work(Work::multiprecision);
    rung = Rung::multiprecision;
    bits = next;
    return true;
}

template <int Dim> void ForceLadder<Dim>::Implementation::bring(Part& part) const {
    ForceSolution& s = part.solution;
    if (!s.value.empty() && s.rung == rung && s.bits == bits && (rough || !part.rough)) {
        return;
    }
    const std::size_t n = part.force.size();
    if (part.zero) {
        s.value.assign(n, 0.0);
        s.low.assign(rung == Rung::double_bound ? 0 : n, 0.0);
        part.unknown.assign(rung == Rung::exact ? n : 0, mpq_class(0));
        part.refined.value.assign(rung == Rung::multiprecision ? n : 0, Real());
    } else if (rung == Rung::exact) {
        part.unknown = exact->solve(part.force, part.terms.products);
        std::vector<Real> x;
        Real error(64);
        Real size(64);
        for (std::size_t l = 0; l < n; ++l) {
            x.push_back(root_product(part.unknown[l], exact->square(ContactId(l)), low_bits));
            mpfr_abs(size.get(), x.back().get(), MPFR_RNDU);
            mpfr_max(error.get(), error.get(), size.get(), MPFR_RNDU);
        }
        mpfr_mul_2si(error.get(), error.get(), -low_bits, MPFR_RNDU); // 8 bits more were carried
        round(x, error, s);
        s.residual = 0;
    } else {
        if (s.value.empty() || part.rough) {
            part.rough = rough;
            s = solve_forces(*structure, *factorisation, *inverse, part.force, s.value.empty() ? part.guess : s.value,
                             rough ? options.first_accuracy : 0);
            part.guess.clear();
            // The accuracy was estimated: where the bound does not confirm what records say, to rounding at once.
            const double largest = largest_of(s.value);
            if (part.rough && !(s.bound <= recorded_accuracy * largest)) {
                part.rough = false;
                s = solve_forces(*structure, *factorisation, *inverse, part.force, s.value);
            }
        }
        if (rung != Rung::double_bound && s.rung == Rung::double_bound) {
            refine_double_double(s, *extended, *structure, *factorisation, *inverse, part.force, part.terms.products);
        }
        if (rung != Rung::multiprecision) {
            inflate(part, s);
        } else {
            std::vector<Real> b;
            std::vector<Real> start;
            for (std::size_t l = 0; l < n; ++l) {
                b.emplace_back(part.force[l], 53);
                Real x(128);
                mpfr_set_d(x.get(), s.value[l], MPFR_RNDN);
                if (!s.low.empty()) {
                    mpfr_add_d(x.get(), x.get(), s.low[l], MPFR_RNDN);
                }
                start.push_back(std::move(x));
            }
            for (const ExactProduct& product : part.terms.products) {
                Real exact_product(128);
                mpfr_set_d(exact_product.get(), -product.a, MPFR_RNDN);
                mpfr_mul_d(exact_product.get(), exact_product.get(), product.b, MPFR_RNDN); // 106 bits
                b[static_cast<std::size_t>(product.row)] = std::move(exact_product);
            }
            Real error(64);
            const double rate_of_load = part.terms.rate;
            mpfr_set_d(error.get(), rate_of_load == 0 ? 0 : rate_of_load * where().away * (1 + 4 * u), MPFR_RNDU);
            part.refined = system->solve(b, part.refined.value.size() == n ? part.refined.value : start, false, error);
            if (part.refined.value.size() == n) {
                round(part.refined.value, part.refined.bound, s);
                s.residual = part.refined.residual;
            } else {
                part.refined.value = std::move(start); // nothing is known
                s.bound = std::numeric_limits<double>::infinity();
            }
        }
    }
    s.rung = rung;
    s.bits = bits;
}

template <int Dim> PreciseInterval ForceLadder<Dim>::Implementation::component(int part, std::size_t l) const {
    Part& p = parts[static_cast<std::size_t>(part)];
    bring(p);
    if (p.zero) {
        return PreciseInterval(low_bits);
    }
    if (rung == Rung::multiprecision) {
        return {p.refined.value[l], p.refined.bound, bits + 32};
    }
    Real value(low_bits);
    mpfr_set_d(value.get(), p.solution.value[l], MPFR_RNDN);
    PreciseInterval result(value, Real(p.solution.bound, 53), low_bits);
    if (!p.solution.low.empty()) {
        mpfr_add_d(result.low.get(), result.low.get(), p.solution.low[l], MPFR_RNDD);
        mpfr_add_d(result.high.get(), result.high.get(), p.solution.low[l], MPFR_RNDU);
    }
    return result;
}

template <int Dim> PreciseInterval ForceLadder<Dim>::Implementation::mechanism_norm(std::size_t l) const {
    const auto known = mechanism.find(l);
    if (known != mechanism.end()) {
        return known->second;
    }
    // On the rungs below MPFR the system of the first MPFR rung is used: it contains them.
    const auto n = static_cast<std::size_t>(structure->size());
    PreciseInterval norm(low_bits);
    mpfr_set_nan(norm.low.get());
    mpfr_set_nan(norm.high.get());
    if (inverse->verdict == Verdict::proved) {
        std::optional<RefinedSystem<Dim>> own;
        if (!system) {
            const double sigma = inverse->sigma_min - where().uncertainty * (1 + 8 * u) - normals() * where().shift;
            if (!(sigma > inverse->sigma_min / 2)) {
                return norm;
            }
            // Normals of the stored configuration: as far from the true ones as on the rung double.
            own.emplace(*structure, exact_coordinates(packing->q, {}), *factorisation, sigma * (1 - 8 * u),
                        Real(vertex == nullptr ? 0.0 : stored_uncertainty(), 53), low_bits);
        }
        const RefinedSystem<Dim>& use = system ? *system : *own;
        std::vector<Real> unit(n, Real(53));
        mpfr_set_ui(unit[l].get(), 1, MPFR_RNDN);
        const RefinedVector v = use.solve(unit, std::vector<Real>(n, Real(53)), true);
        if (v.value.size() == n) {
            norm = PreciseInterval(use.bits() + 32);
            for (const Real& c : v.value) {
                PreciseInterval point(use.bits() + 32);
                mpfr_set(point.low.get(), c.get(), MPFR_RNDD);
                mpfr_set(point.high.get(), c.get(), MPFR_RNDU);
                norm = norm + point * point;
            }
            mpfr_sqrt(norm.low.get(), norm.low.get(), MPFR_RNDD);
            mpfr_sqrt(norm.high.get(), norm.high.get(), MPFR_RNDU);
            mpfr_sub(norm.low.get(), norm.low.get(), v.bound.get(), MPFR_RNDD);
            mpfr_add(norm.high.get(), norm.high.get(), v.bound.get(), MPFR_RNDU);
        }
    }
    mechanism.insert_or_assign(l, norm);
    return norm;
}

template <int Dim> PreciseInterval ForceLadder<Dim>::Implementation::evaluate(const ForceExpression& e) const {
    const std::size_t l = e.contact.index();
    PreciseInterval value = component(e.part, l);
    if (e.slope_part >= 0 && (e.at != e.from || e.shift != nullptr)) {
        PreciseInterval way = difference(e.at, e.from, value.bits());
        if (e.shift != nullptr) {
            way = way + e.shift->value(bits);
        }
        value = value + way * component(e.slope_part, l);
    }
    if (e.minus_magnitude) {
        value = -magnitude(value);
    }
    if (e.divisor != ForceExpression::Divisor::none) {
        const PreciseInterval by =
            e.divisor == ForceExpression::Divisor::part ? magnitude(component(e.divisor_part, l)) : mechanism_norm(l);
        if (!by.positive()) {
            mpfr_set_nan(value.low.get());
            mpfr_set_nan(value.high.get());
            return value;
        }
        value = value / by;
    }
    return value;
}

template <int Dim>
mpq_class ForceLadder<Dim>::Implementation::exact_value(const ForceExpression& e, mpq_class& square) const {
    const std::size_t l = e.contact.index();
    const auto unknown = [&](int part) -> const mpq_class& {
        Part& p = parts[static_cast<std::size_t>(part)];
        bring(p);
        return p.unknown[l];
    };
    mpq_class value = unknown(e.part);
    if (e.slope_part >= 0 && e.at != e.from) {
        value += (mpq_class(e.at) - mpq_class(e.from)) * unknown(e.slope_part);
    }
    if (e.minus_magnitude) {
        value = -abs(value);
    }
    switch (e.divisor) {
    case ForceExpression::Divisor::none: square = value * value * exact->square(e.contact); break;
    case ForceExpression::Divisor::part: {
        value /= abs(unknown(e.divisor_part)); // the roots cancel
        square = value * value;
        break;
    }
    case ForceExpression::Divisor::mechanism: {
        auto known = mechanism_square.find(l);
        if (known == mechanism_square.end()) {
            known = mechanism_square.emplace(l, exact->mechanism_square(e.contact)).first;
        }
        square = value * value / known->second; // the roots cancel
        break;
    }
    }
    return value;
}

template <int Dim> bool ForceLadder<Dim>::Implementation::open_exact() {
    if (structure->size() > options.exact_size || !exact_allowed) {
        return false;
    }
    const auto finite = [](const Part& part) { // a load beyond the range of double is no number to begin with
        return std::all_of(part.force.begin(), part.force.end(), [](double f) { return std::isfinite(f); });
    };
    if (!std::all_of(parts.begin(), parts.end(), finite)) {
        return false;
    }
    if (vertex != nullptr) { // the stored configuration must be the true vertex, not only near it
        const auto closed = [&](const Contact& c) {
            return c.kind == ContactKind::held || gap_sign(*packing, c, 0) == 0;
        };
        const auto& contacts = structure->contacts();
        const bool loads_exact =
            std::all_of(parts.begin(), parts.end(), [](const Part& part) { return part.terms.rate == 0 || part.zero; });
        if (vertex->verdict != Verdict::proved || !loads_exact ||
            !std::all_of(contacts.begin(), contacts.end(), closed)) {
            return false;
        }
    }
    count_work(Work::exact_solutions);
    exact.emplace(*packing, *structure);
    if (!exact->regular()) {
        exact.reset();
        return false;
    }
    rung = Rung::exact;
    bits = 0;
    return true;
}

/// The last rung in MPFR used its bits: more of them will tell more.
template <int Dim> bool ForceLadder<Dim>::Implementation::converged() const {
    return std::all_of(parts.begin(), parts.end(), [&](const Part& part) {
        if (part.zero || part.solution.value.empty() || part.solution.rung != rung || part.solution.bits != bits) {
            return true;
        }
        Real size(64);
        Real upper(64);
        for (const Real& x : part.refined.value) {
            mpfr_abs(upper.get(), x.get(), MPFR_RNDU);
            mpfr_max(size.get(), size.get(), upper.get(), MPFR_RNDU);
        }
        mpfr_mul_2si(size.get(), size.get(), -bits / 2, MPFR_RNDN);
        return mpfr_lessequal_p(part.refined.bound.get(), size.get()) != 0;
    });
}

template <int Dim>
ForceLadder<Dim>::ForceLadder(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                              const Factorisation& factorisation, const InverseBound& inverse, LadderOptions options,
                              const VertexEnclosure* vertex)
    : implementation_(std::make_unique<Implementation>()) {
    implementation_->packing = &packing;
    implementation_->structure = &structure;
    implementation_->factorisation = &factorisation;
    implementation_->inverse = &inverse;
    implementation_->options = options;
    implementation_->vertex = vertex;
    implementation_->rough = options.first_accuracy > 0 && !factorisation.is_fresh();
}

template <int Dim> ForceLadder<Dim>::~ForceLadder() = default;
template <int Dim> ForceLadder<Dim>::ForceLadder(ForceLadder&&) noexcept = default;
template <int Dim> ForceLadder<Dim>& ForceLadder<Dim>::operator=(ForceLadder&&) noexcept = default;

template <int Dim> double ForceLadder<Dim>::normal_uncertainty() const {
    return implementation_->vertex == nullptr ? 0 : implementation_->stored_uncertainty();
}

template <int Dim> int ForceLadder<Dim>::add(std::vector<double> force, LoadTerms terms, std::vector<double> guess) {
    Part part;
    part.zero = all_zero(force) && std::all_of(terms.products.begin(), terms.products.end(), [](const ExactProduct& p) {
                    return p.a == 0 || p.b == 0; // a product may underflow
                });
    part.terms = std::move(terms);
    part.force = std::move(force);
    part.guess = std::move(guess);
    implementation_->parts.push_back(std::move(part));
    return static_cast<int>(implementation_->parts.size()) - 1;
}

template <int Dim> const std::vector<double>& ForceLadder<Dim>::force(int part) const {
    return implementation_->parts[static_cast<std::size_t>(part)].force;
}

template <int Dim> const ForceSolution& ForceLadder<Dim>::solution(int part) const {
    Part& p = implementation_->parts[static_cast<std::size_t>(part)];
    implementation_->bring(p);
    return p.solution;
}

template <int Dim> std::span<const double> ForceLadder<Dim>::known(int part) const {
    return implementation_->parts[static_cast<std::size_t>(part)].solution.value;
}

template <int Dim> std::string ForceLadder<Dim>::digits(int part, ContactId contact, int bits) const {
    const Implementation& self = *implementation_;
    Part& p = self.parts[static_cast<std::size_t>(part)];
    self.bring(p);
    const std::size_t l = contact.index();
    Real value(std::max<mpfr_prec_t>(bits, 2));
    if (self.rung == Rung::exact && !p.zero) {
        const Real product = root_product(p.unknown[l], self.exact->square(contact), bits); // mpfr_set is a macro
        mpfr_set(value.get(), product.get(), MPFR_RNDN);
    } else if (self.rung == Rung::multiprecision && !p.zero) {
        mpfr_set(value.get(), p.refined.value[l].get(), MPFR_RNDN);
    } else {
        Real sum(2200); // exact for any two doubles
        mpfr_set_d(sum.get(), p.solution.value[l], MPFR_RNDN);
        mpfr_add_d(sum.get(), sum.get(), p.solution.low.empty() ? 0.0 : p.solution.low[l], MPFR_RNDN);
        mpfr_set(value.get(), sum.get(), MPFR_RNDN);
    }
    char* text = nullptr;
    mpfr_asprintf(&text, "%Ra", value.get());
    std::string result(text);
    mpfr_free_str(text);
    return result;
}

template <int Dim> double ForceLadder<Dim>::bound_exponent(int part) const {
    Part& p = implementation_->parts[static_cast<std::size_t>(part)];
    implementation_->bring(p);
    if (p.zero || implementation_->rung == Rung::exact) {
        return -std::numeric_limits<double>::infinity();
    }
    if (implementation_->rung != Rung::multiprecision) {
        return std::log2(p.solution.bound) + 1e-12;
    }
    Real logarithm(64);
    mpfr_log2(logarithm.get(), p.refined.bound.get(), MPFR_RNDU);
    return logarithm.above();
}

template <int Dim> bool ForceLadder<Dim>::climb() {
    Implementation& self = *implementation_;
    const bool bounded = self.inverse->verdict == Verdict::proved;
    self.mechanism.clear();
    if (self.rough) {
        self.rough = false;
        return true;
    }
    switch (self.rung) {
    case Rung::double_bound:
        if (!bounded) {
            return self.open_exact();
        }
        return self.extend() || self.refine(self.options.first_bits) || self.open_exact();
    case Rung::double_double:
    case Rung::multiprecision: {
        const int next = self.rung == Rung::double_double ? self.options.first_bits : 2 * self.bits;
        if (next > self.options.max_bits || (self.rung == Rung::multiprecision && !self.converged())) {
            return self.open_exact();
        }
        return self.refine(next) || self.open_exact();
    }
    default: return false;
    }
}

template <int Dim> Rung ForceLadder<Dim>::rung() const {
    return implementation_->rung;
}

template <int Dim> int ForceLadder<Dim>::bits() const {
    return implementation_->bits;
}

namespace {

Order order_of(const PreciseInterval& value, Rung rung, int bits) {
    Order order{false, 0, 0, rung, bits};
    if (value.positive() || value.negative()) {
        order.decided = true;
        order.sign = value.positive() ? 1 : -1;
        order.margin = value.margin();
    } else if (value.zero()) {
        order.decided = true;
        order.margin = std::numeric_limits<double>::infinity();
        order.exponent = -std::numeric_limits<double>::infinity();
    } else {
        Real size(64);
        const PreciseInterval absolute = magnitude(value);
        mpfr_log2(size.get(), absolute.high.get(), MPFR_RNDU);
        order.exponent = mpfr_nan_p(size.get()) != 0 ? std::numeric_limits<double>::infinity() : size.above();
    }
    return order;
}

/// An exact number of which only the sign is known.
Order exact_order(int sign) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {true, sign, infinity, Rung::exact, 0, sign == 0 ? -infinity : infinity};
}

} // namespace

template <int Dim> Order ForceLadder<Dim>::sign(const ForceExpression& a) const {
    const Implementation& self = *implementation_;
    if (self.rung != Rung::exact) {
        return order_of(self.evaluate(a), self.rung, self.bits);
    }
    ForceExpression numerator = a; // divisors are positive
    numerator.divisor = ForceExpression::Divisor::none;
    mpq_class square;
    return exact_order(sgn(self.exact_value(numerator, square)));
}

template <int Dim> Order ForceLadder<Dim>::compare(const ForceExpression& a, const ForceExpression& b) const {
    const Implementation& self = *implementation_;
    if (self.rung != Rung::exact) {
        return order_of(self.evaluate(a) - self.evaluate(b), self.rung, self.bits);
    }
    mpq_class square_a;
    mpq_class square_b;
    const int sign_a = sgn(self.exact_value(a, square_a));
    const int sign_b = sgn(self.exact_value(b, square_b));
    const int sign = sign_a != sign_b ? (sign_a > sign_b ? 1 : -1) : sign_a * sgn(mpq_class(square_a - square_b));
    return exact_order(sign);
}

namespace {

/// -(p + (at - from) s) / s from the solutions of a ladder that climbs when it must.
template <int Dim> class ZeroOfForce final : public LoadShift {
  public:
    using Value = std::function<PreciseInterval(int)>;
    explicit ZeroOfForce(Value value) : value_(std::move(value)) {}
    [[nodiscard]] PreciseInterval value(int bits) const override { return value_(bits); }

  private:
    Value value_;
};

} // namespace

bool is_tie(const Order& order, double size) {
    if (order.decided) {
        return order.sign == 0;
    }
    return size > 0 && order.exponent <= std::log2(size) - tie_bits;
}

template <int Dim> void ForceLadder<Dim>::without_exact_numbers() {
    implementation_->exact_allowed = false;
}

template <int Dim> std::shared_ptr<const LoadShift> ForceLadder<Dim>::zero_of(const ForceExpression& force) {
    const auto value = [this, force](int bits) {
        while (rung() != Rung::exact && this->bits() < bits && climb()) {
        }
        const Implementation& self = *implementation_;
        const std::size_t l = force.contact.index();
        if (self.rung == Rung::exact) {
            mpq_class square;
            mpq_class ratio = self.exact_value(force, square);
            Part& slope = self.parts[static_cast<std::size_t>(force.slope_part)];
            self.bring(slope);
            ratio /= slope.unknown[l];
            PreciseInterval result(std::max(bits + 32, 160));
            mpfr_set_q(result.low.get(), mpq_class(-ratio).get_mpq_t(), MPFR_RNDD);
            mpfr_set_q(result.high.get(), mpq_class(-ratio).get_mpq_t(), MPFR_RNDU);
            return result;
        }
        const PreciseInterval slope = self.component(force.slope_part, l);
        const PreciseInterval p = self.evaluate(force);
        const PreciseInterval quotient = p / magnitude(slope);
        return slope.positive() ? -quotient : quotient;
    };
    return std::make_shared<ZeroOfForce<Dim>>(value);
}

template class ForceLadder<2>;

} // namespace isostat
