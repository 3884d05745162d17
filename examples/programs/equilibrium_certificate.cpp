// A certificate of an equilibrium for a proof assistant: what `isostat certify` claims of a packing in a box or a
// periodic cell, as a Coq file with the integers from which proofs/coq/load_certificate.v proves it. Usage:
// equilibrium_certificate [CERTIFICATE.json | DISKS [SEED]] > file.v; without a file a random packing is prepared.
// Nothing here has to be right: Coq checks every number, and proofs/coq/compare.py compares them with the file.
#include <isostat/certificate/certify.hpp>
#include <isostat/core/result.hpp>
#include <isostat/exact/number.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/preparation/preparation.hpp>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace isostat;
using exact::Number;
using Numbers = std::vector<Number>;
using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// Nothing is wrong with the certificate; this program has no data with which Coq could prove what it claims.
class Undecided : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

constexpr int zoom_exponent = 64; // the unit of the refined configuration is 2^64 times smaller

Number power_of_two(int exponent) {
    return Number::from_double(std::ldexp(1.0, exponent));
}

Number size(const Number& x) {
    return x.sign() < 0 ? -x : x;
}

/// The integer next to x.
Number rounded(double x) {
    return Number::from_double(std::abs(x) < 0x1p53 ? std::nearbyint(x) : x);
}

/// An integer above x >= 0, by a little.
Number above(const Number& x) {
    return rounded(std::ceil(x.to_double() * (1 + 0x1p-40))) + 1;
}

/// Largest e <= 0 such that x is an integer multiple of 2^e.
int unit_exponent(double x, int e) {
    while (x != 0 && std::ldexp(x, -e) != std::floor(std::ldexp(x, -e))) {
        --e;
    }
    return e;
}

int unit_exponent(const std::vector<double>& values, int e) {
    for (const double x : values) {
        e = unit_exponent(x, e);
    }
    return e;
}

/// One row of the derivative: coordinates and entries, and how much an entry changes when no coordinate changes by more
/// than 1.
struct Entry {
    int coordinate = 0;
    Number value;
    int change = 0;
};

/// A coordinate in a separation, with its factor.
struct Term {
    int coordinate = 0;
    int factor = 0;
};

int spread(const std::vector<Term>& terms) {
    return std::accumulate(terms.begin(), terms.end(), 0,
                           [](int sum, const Term& term) { return sum + std::abs(term.factor); });
}

/// The packing in integers of one unit. The coordinates are those of the grains, the lengths and the tilts, of a box as
/// well. Those that do not move are held at their places, by rows after those of the contacts.
struct Integers {
    int dimension = 2;
    int disks = 0;
    Numbers radius;
    Numbers place;
    Number weight;
    std::vector<Contact> contacts;

    [[nodiscard]] int at(int disk, int axis) const { return dimension * disk + axis; }

    /// What the separation of grain i from the image of grain j is the sum of, along axis a.
    [[nodiscard]] std::vector<Term> along(const Contact& c, int a) const {
        std::vector<Term> terms;
        if (c.i != c.j) {
            terms = {{at(c.i, a), 1}, {at(c.j, a), -1}};
        }
        const Layout layout{dimension, disks};
        for (std::size_t b = index(a); b < layout.axes(); ++b) {
            if (c.image.m[b] != 0) {
                const std::size_t period = b == index(a) ? layout.of_length(b) : layout.of_tilt(index(a), b);
                terms.push_back({static_cast<int>(period), -c.image.m[b]});
            }
        }
        return terms;
    }
    [[nodiscard]] Number separation(const Contact& c, int a, const Numbers& q) const {
        Number sum;
        for (const Term& term : along(c, a)) {
            sum += term.factor * q[index(term.coordinate)];
        }
        return sum;
    }
    /// K1 (b): where no grain touches an image 8 in the plane, 12 in space.
    [[nodiscard]] int curvature() const {
        int most = 1;
        for (const Contact& c : contacts) {
            if (c.kind == ContactKind::disk_disk) {
                int sum = 0;
                for (int a = 0; a < dimension; ++a) {
                    const int change = spread(along(c, a));
                    sum += change * change;
                }
                most = std::max(most, sum);
            }
        }
        return most;
    }

    /// Twice the polynomial of a contact, and half its derivative: those of proofs/coq/box.v.
    [[nodiscard]] Number doubled_gap(const Contact& c, const Numbers& q) const {
        if (c.kind == ContactKind::disk_disk) {
            const Number sum = radius[index(c.i)] + radius[index(c.j)];
            Number gap = -(sum * sum);
            for (int a = 0; a < dimension; ++a) {
                const Number x = separation(c, a, q);
                gap += x * x;
            }
            return gap;
        }
        const Number x = q[index(at(c.i, c.j))];
        if (c.kind == ContactKind::held) {
            return (weight + weight) * (x - place[index(at(c.i, c.j))]);
        }
        const Number room = c.kind == ContactKind::lower_wall ? x : q[index(at(disks, c.j))] - x;
        return (weight + weight) * (room - radius[index(c.i)]);
    }
    [[nodiscard]] std::vector<Entry> gradient(const Contact& c, const Numbers& q) const {
        if (c.kind == ContactKind::disk_disk) {
            std::vector<Entry> entries;
            for (int a = 0; a < dimension; ++a) {
                const Number size = separation(c, a, q);
                const std::vector<Term> terms = along(c, a);
                for (const Term& term : terms) {
                    entries.push_back({term.coordinate, term.factor * size, std::abs(term.factor) * spread(terms)});
                }
            }
            return entries;
        }
        if (c.kind != ContactKind::upper_wall) {
            return {{at(c.i, c.j), weight}};
        }
        return {{at(disks, c.j), weight}, {at(c.i, c.j), -weight}};
    }
    [[nodiscard]] Number length(const Contact& c) const {
        return c.kind == ContactKind::disk_disk ? radius[index(c.i)] + radius[index(c.j)] : weight;
    }
    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
};

/// A in doubles and a factor of A^T A: it serves for every approximate solution.
struct Approximate {
    Matrix a;
    Eigen::SimplicialLLT<Matrix> factor;

    Approximate(const Integers& packing, const Numbers& q) : a(static_cast<int>(q.size()), static_cast<int>(q.size())) {
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t l = 0; l < packing.contacts.size(); ++l) {
            for (const Entry& e : packing.gradient(packing.contacts[l], q)) {
                entries.emplace_back(static_cast<int>(l), e.coordinate, e.value.to_double());
            }
        }
        a.setFromTriplets(entries.begin(), entries.end());
        factor.compute(Matrix(a.transpose() * a));
        if (factor.info() != Eigen::Success) {
            throw Undecided("the contact matrix is too near a singular one for a factor in double");
        }
    }
    /// A x = b.
    [[nodiscard]] Vector solve(const Vector& b) const { return factor.solve(a.transpose() * b); }
    /// A^T x = b.
    [[nodiscard]] Vector solve_transposed(const Vector& b) const { return a * factor.solve(b); }
    /// The smallest eigenvalue of A^T A, by inverse iteration.
    [[nodiscard]] double smallest_eigenvalue() const {
        Vector x = Vector::Ones(a.cols());
        double inverse = 0;
        for (int k = 0; k < 200; ++k) {
            const Vector direction = x / x.norm();
            x = factor.solve(direction);
            inverse = x.norm();
        }
        return 1 / inverse;
    }
};

Vector to_doubles(const Numbers& x) {
    Vector result(static_cast<Eigen::Index>(x.size()));
    for (std::size_t k = 0; k < x.size(); ++k) {
        result[static_cast<Eigen::Index>(k)] = x[k].to_double();
    }
    return result;
}

Number largest(const Numbers& x) {
    Number result;
    for (const Number& a : x) {
        result = std::max(result, size(a));
    }
    return result;
}

/// Adds the rounded step to x.
void add_rounded(Numbers& x, const Vector& step) {
    for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] += rounded(step[static_cast<Eigen::Index>(k)]);
    }
}

/// The vertex next to q, in integers: Newton's steps with exact residuals. `left`: the largest doubled gap there.
Numbers refined(const Integers& packing, Numbers q, const Approximate& system, Number& left) {
    Numbers gaps(packing.contacts.size());
    for (int step = 0;; ++step) {
        for (std::size_t l = 0; l < gaps.size(); ++l) {
            gaps[l] = packing.doubled_gap(packing.contacts[l], q);
        }
        left = largest(gaps);
        if (step == 6) {
            return q;
        }
        add_rounded(q, system.solve(-0.5 * to_doubles(gaps)));
    }
}

/// Forces over lengths times `fraction`, in integers, and what they may be off.
struct Quotients {
    int fraction = 0; ///< exponent
    Numbers value;
    Number slack;
};

Quotients quotients(const Integers& packing, const Numbers& q, const Numbers& load, const Approximate& system,
                    const Number& error, const Number& stiffness) {
    Quotients result;
    const double length = system.solve_transposed(to_doubles(load)).lpNorm<Eigen::Infinity>();
    result.fraction = length > 0 ? std::max(0, 100 - std::ilogb(length)) : 0;
    result.value.assign(packing.contacts.size(), Number());
    for (int step = 0;; ++step) {
        Numbers residual(load.size());
        Numbers blur(load.size());
        for (std::size_t k = 0; k < load.size(); ++k) {
            residual[k] = power_of_two(result.fraction) * load[k];
        }
        for (std::size_t l = 0; l < packing.contacts.size(); ++l) {
            const Number& g = result.value[l];
            for (const Entry& e : packing.gradient(packing.contacts[l], q)) {
                residual[Integers::index(e.coordinate)] += e.value * g;
                blur[Integers::index(e.coordinate)] += e.change * size(g);
            }
        }
        if (step == 12) {
            result.slack = above((largest(residual) + error * largest(blur)) / stiffness);
            return result;
        }
        add_rounded(result.value, system.solve_transposed(-to_doubles(residual)));
    }
}

// What follows writes Coq.

/// In hexadecimal digits, which Coq reads in less time than decimal ones.
std::string numeral(const Number& x) {
    const std::string digits = mpz_class(size(x).text()).get_str(16);
    return (x.sign() < 0 ? "-0x" : "0x") + digits;
}

std::string list(const std::vector<std::string>& items) {
    std::string text = "[::";
    for (std::size_t k = 0; k < items.size(); ++k) {
        text += (k == 0 ? " " : k % 8 == 0 ? ";\n  " : "; ") + items[k];
    }
    return text + "]";
}
std::string list(const Numbers& numbers) {
    std::vector<std::string> items;
    for (const Number& x : numbers) {
        items.push_back(numeral(x));
    }
    return list(items);
}
std::string list(const std::vector<bool>& flags) {
    std::vector<std::string> items;
    for (const bool flag : flags) {
        items.emplace_back(flag ? "true" : "false");
    }
    return list(items);
}

std::string name(const Integers& packing, const Contact& c) {
    if (c.kind == ContactKind::held) {
        return "Held " + std::to_string(packing.at(c.i, c.j));
    }
    const auto both = std::to_string(c.i) + " " + std::to_string(c.j);
    if (c.kind == ContactKind::disk_disk && !c.image.is_here()) {
        std::string text = "Image " + both;
        for (const int periods : c.image.m) {
            text += " (" + std::to_string(periods) + ")";
        }
        return text;
    }
    const char* kind = c.kind == ContactKind::disk_disk    ? "Disks"
                       : c.kind == ContactKind::lower_wall ? "Lower"
                                                           : "Upper";
    return std::string(kind) + " " + both;
}

/// Columns of P^T L, P the permutation of the factor: A^T A - s I = L L^T, in integers of the unit. Coq merges them
/// quickly where their rows are in order.
std::string factor_columns(const Matrix& squared, double shift) {
    Matrix shifted = squared;
    for (Eigen::Index k = 0; k < shifted.cols(); ++k) {
        shifted.coeffRef(k, k) -= shift;
    }
    Eigen::SimplicialLLT<Matrix> factor(shifted);
    if (factor.info() != Eigen::Success) {
        throw Undecided("the shifted matrix has no factor");
    }
    const Matrix lower = factor.matrixL();
    std::vector<std::string> items;
    for (Eigen::Index k = 0; k < lower.outerSize(); ++k) {
        std::map<Eigen::Index, std::string> column;
        for (Matrix::InnerIterator it(lower, k); it; ++it) {
            column[factor.permutationPinv().indices()[it.row()]] = numeral(rounded(it.value()));
        }
        std::vector<std::string> entries;
        for (const auto& [row, value] : column) {
            entries.push_back("(" + std::to_string(row) + ", " + value + ")");
        }
        items.push_back(list(entries));
    }
    return list(items);
}

/// The vertex next to a stored packing, with what proves it. The first three are in units 2^fine, the others in 2^unit.
struct Vertex {
    int unit = 0;
    int fine = 0;
    Numbers refined;
    Number error;
    Number distance;
    Integers packing;
    Numbers stored;
    Number ball;
    Number stiffness;
    Number shift;
    std::string factor;
};

/// A packing in a unit `zoom` times smaller.
Integers enlarged(Integers packing, const Number& zoom) {
    packing.weight *= zoom;
    for (Numbers* lengths : {&packing.radius, &packing.place}) {
        for (Number& x : *lengths) {
            x *= zoom;
        }
    }
    return packing;
}

Numbers multiples(const std::vector<double>& values, int exponent) {
    Numbers result;
    for (const double x : values) {
        result.push_back(Number::from_double(x) / power_of_two(exponent));
    }
    return result;
}

Vertex vertex_of(const Packing& packing, const std::vector<Contact>& rows, double unique_radius) {
    Vertex v;
    v.unit = unit_exponent(packing.radius, unit_exponent(packing.q, 0));
    v.fine = v.unit - zoom_exponent;
    v.stored = multiples(packing.q, v.unit);
    v.stored.resize(rows.size()); // a box has no tilt
    v.packing = {packing.dimension,
                 packing.disk_count(),
                 multiples(packing.radius, v.unit),
                 v.stored,
                 power_of_two(std::ilogb(packing.radius[0]) - v.unit + 1),
                 rows};
    const Approximate coarse(v.packing, v.stored);
    const double shift = 0.7 * coarse.smallest_eigenvalue();
    const double ball = std::ceil(std::ldexp(unique_radius, -v.unit));
    const double bend = v.packing.curvature() * ball;
    const double stiffness = 0.9 * shift / (2.0 * static_cast<double>(v.stored.size())) - bend * bend;
    if (!(stiffness > 0)) {
        throw Undecided("the claimed radius of uniqueness is too large for this certificate");
    }
    v.shift = rounded(shift);
    v.ball = rounded(ball);
    v.stiffness = rounded(std::floor(std::sqrt(stiffness)));
    v.factor = factor_columns(Matrix(coarse.a.transpose() * coarse.a), shift);

    const Number zoom = power_of_two(zoom_exponent);
    Numbers start = v.stored;
    for (Number& x : start) {
        x *= zoom;
    }
    const Integers small = enlarged(v.packing, zoom);
    Number left;
    v.refined = refined(small, start, Approximate(small, start), left);
    v.error = above(left / (2 * v.stiffness * zoom));
    Numbers moved = start;
    for (std::size_t k = 0; k < moved.size(); ++k) {
        moved[k] -= v.refined[k];
    }
    v.distance = largest(moved) + v.error;
    return v;
}

/// Of grains, lengths and tilts.
std::size_t coordinates_of(const Packing& packing) {
    return packing.length_at(packing.axes()) + packing.tilts();
}

/// What a stress presses on: a length in the plane, an area in space.
Number area_of(const WallForce& wall) {
    return Number::from_double(wall.length) * Number::from_double(wall.other);
}

/// The wall forces are exact products of stored numbers.
Numbers finite_load(const State& state, int exponent) {
    Numbers load = multiples(state.load.disk_force, exponent);
    load.resize(coordinates_of(state.packing));
    for (const WallForce& wall : state.load.wall_forces(state.packing)) {
        const Number force = Number::from_double(wall.stress) * area_of(wall);
        load[Integers::index(wall.coordinate)] = -force / power_of_two(exponent);
    }
    return load;
}

/// Its change per unit of the loaded stress.
Numbers unit_load(const State& state, int exponent) {
    Numbers load(coordinates_of(state.packing));
    for (const WallForce& wall : state.load.wall_forces(state.packing)) {
        load[Integers::index(wall.coordinate)] =
            -Number::from_double(wall.rate) * area_of(wall) / power_of_two(exponent);
    }
    return load;
}

/// A common unit of the loads and of the ends of the intervals.
int force_exponent(std::vector<double> numbers, const std::vector<Interval>& intervals) {
    for (const Interval& interval : intervals) {
        numbers.insert(numbers.end(), {interval.lower, interval.upper});
    }
    return unit_exponent(numbers, 0);
}

/// Degrees of freedom without load that only contacts without force touch.
std::vector<bool> unloaded_by(const Vertex& v, const Numbers& load, const std::vector<bool>& zeros) {
    std::vector<bool> result;
    for (const Number& force : load) {
        result.push_back(force.is_zero());
    }
    for (std::size_t l = 0; l < zeros.size(); ++l) {
        for (const Entry& e : v.packing.gradient(v.packing.contacts[l], v.stored)) {
            result[Integers::index(e.coordinate)] = result[Integers::index(e.coordinate)] && zeros[l];
        }
    }
    return result;
}

void write_vertex(const Vertex& v, const Packing& packing) {
    std::vector<std::string> contacts;
    for (const Contact& c : v.packing.contacts) {
        contacts.push_back(name(v.packing, c));
    }
    std::printf(
        "(* The data of a certificate, for proofs/coq/questions/verdict.v. *)\n"
        "From Coq Require Import ZArith List.\nFrom mathcomp Require Import all_ssreflect all_algebra.\n"
        "From Isostat Require Import contact_certificate box_certificate equilibrium_certificate load_certificate.\n"
        "Definition touching : seq contact := %s.\nOpen Scope Z_scope.\n",
        list(contacts).c_str());
    std::vector<bool> there;
    for (const auto& kinds : {packing.walls.lower, packing.walls.upper}) {
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            there.push_back(kinds[a] != WallKind::absent);
        }
    }
    const std::vector<bool> periodic(packing.cell.periodic.begin(), packing.cell.periodic.begin() + packing.dimension);
    std::printf(
        "Definition the_vertex : vertex_certificate := {|\n  lies_in := %s;\n  disks := %d;\n  contacts := touching;\n"
        "  walls := %s;\n  periodic := %s;\n  stored := %s;\n  radii := %s;\n  weight := %s;\n  zoom := "
        "%s;\n  refined := %s;\n",
        packing.dimension == plane ? "Plane" : "Space", v.packing.disks, list(there).c_str(), list(periodic).c_str(),
        list(v.stored).c_str(), list(v.packing.radius).c_str(), v.packing.weight.text().c_str(),
        numeral(power_of_two(zoom_exponent)).c_str(), list(v.refined).c_str());
    std::printf("  error := %s;\n  distance := %s;\n  ball := %s;\n  stiffness := %s;\n  shift := %s;\n"
                "  factor := %s |}.\n",
                v.error.text().c_str(), v.distance.text().c_str(), v.ball.text().c_str(), v.stiffness.text().c_str(),
                v.shift.text().c_str(), v.factor.c_str());
}

void write_solution(const Numbers& load, const Quotients& forces) {
    std::printf("{|\n  load := %s;\n  fraction := %s;\n  quotients := %s;\n  slack := %s |}", list(load).c_str(),
                numeral(power_of_two(forces.fraction)).c_str(), list(forces.value).c_str(),
                forces.slack.text().c_str());
}

void write_forces(const char* title, const Numbers& load, const Quotients& forces,
                  const std::vector<Interval>& intervals, int exponent) {
    std::vector<double> low;
    std::vector<double> high;
    for (const Interval& interval : intervals) {
        low.push_back(interval.lower);
        high.push_back(interval.upper);
    }
    std::printf("Definition %s : force_claim := {| solution := ", title);
    write_solution(load, forces);
    std::printf(";\n  low := %s;\n  high := %s |}.\n", list(multiples(low, exponent)).c_str(),
                list(multiples(high, exponent)).c_str());
}

/// One end of the interval, with the contacts that bear nothing there.
struct EndWriter {
    const State& state;
    const Vertex& vertex;
    const Numbers& load;
    const Quotients& forces;
    const Numbers& rate;
    const Quotients& slopes;
    const std::vector<bool>& zeros;
    int stress_unit;

    /// Force l is still positive where that of m vanishes: `outlasts` of load_certificate.v.
    [[nodiscard]] bool outlasts(std::size_t m, std::size_t l, int direction) const {
        const auto uncertain = [this](const Number& g, const Number& h) {
            return size(g) * slopes.slack + size(h) * forces.slack + forces.slack * slopes.slack;
        };
        const Number& gl = forces.value[l];
        const Number& gm = forces.value[m];
        const Number fall_l = -direction * slopes.value[l];
        const Number fall_m = -direction * slopes.value[m];
        return uncertain(gl, fall_m) + uncertain(gm, fall_l) < gl * fall_m - gm * fall_l;
    }
    void write(const char* title, const LoadEndClaim& claim, int direction) const {
        const auto found = std::find(state.contacts.begin(), state.contacts.end(), claim.opens);
        const auto m = static_cast<std::size_t>(found - state.contacts.begin());
        if (!claim.unbounded && m == state.contacts.size()) {
            throw Error(ErrorKind::bad_input, "what opens at an end of the load interval is no contact");
        }
        std::vector<bool> mute = zeros;
        Numbers any_load = rate;
        for (std::size_t l = 0; l < mute.size(); ++l) {
            mute[l] = vertex.packing.contacts[l].kind == ContactKind::held ? false
                      : claim.unbounded ? !(slopes.slack < direction * slopes.value[l])
                                        : zeros[l] || l == m || !outlasts(m, l, direction);
            any_load[l] = size(rate[l]) + (claim.unbounded ? Number() : size(load[l]));
        }
        const std::vector<double> ends = claim.unbounded ? std::vector<double>{0, 0}
                                         : direction > 0 ? std::vector<double>{claim.stress.lower, claim.stress.upper}
                                                         : std::vector<double>{claim.stress.upper, claim.stress.lower};
        const Numbers stress = multiples(ends, stress_unit);
        std::printf("Definition %s : load_end := {|\n  opens := %s;\n  mute := %s;\n  free := %s;\n  near := %s;\n"
                    "  far := %s |}.\n",
                    title, claim.unbounded ? "None" : ("Some " + std::to_string(m) + "%nat").c_str(),
                    list(mute).c_str(), list(unloaded_by(vertex, any_load, mute)).c_str(), stress[0].text().c_str(),
                    stress[1].text().c_str());
    }
};

/// Powers of two: the units of forces and stresses, so that the load per unit of stress has their quotient as its own.
struct ForceUnits {
    int force = 0;
    int small = 0;
    int stress = 0;
};

ForceUnits force_units(const State& state, const CertificateClaims& claims,
                       const std::vector<Interval>& infinitesimal) {
    ForceUnits units;
    units.force = force_exponent(state.load.disk_force, claims.forces->finite);
    units.small = force_exponent(state.load.infinitesimal, infinitesimal);
    units.stress = unit_exponent(state.load.loaded_stress(), 0);
    for (const LoadEndClaim& end : {claims.load_interval->low, claims.load_interval->high}) {
        if (!end.unbounded) {
            units.stress = unit_exponent({end.stress.lower, end.stress.upper}, units.stress);
        }
    }
    int areas = 0;
    for (const WallForce& wall : state.load.wall_forces(state.packing)) {
        const int area = unit_exponent(wall.length, 0) + unit_exponent(wall.other, 0);
        areas = std::min(areas, area);
        units.force = std::min(units.force, unit_exponent(wall.stress, 0) + area);
    }
    units.force = std::min(units.force, units.stress + areas);
    return units;
}

/// The contacts, and what is held: the coordinates that are no degrees of freedom.
std::vector<Contact> rows_of(const State& state) {
    std::vector<Contact> rows = state.contacts;
    const DofMap dofs(state.packing);
    const int d = state.packing.dimension;
    for (int k = 0; k < static_cast<int>(coordinates_of(state.packing)); ++k) {
        if (k >= dofs.coordinate_count() || dofs.dof_of(Integers::index(k)) < 0) { // a box has no tilt
            rows.push_back({ContactKind::held, k / d, k % d});
        }
    }
    return rows;
}

/// Of a cell.
bool pinned_disk_bears_force(const State& state, const ForcesClaim& forces) {
    const int pin = state.packing.cell.pin;
    const std::vector<int>& zeros = forces.structural_zeros;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& c = state.contacts[l];
        const bool zero = std::find(zeros.begin(), zeros.end(), static_cast<int>(l)) != zeros.end();
        if (!zero && (c.i == pin || (c.of_disks() && c.j == pin))) {
            return true;
        }
    }
    return false;
}

void require_covered(const State& state, const CertificateClaims& claims, const std::vector<Contact>& rows) {
    const Packing& packing = state.packing;
    const std::pair<bool, const char*> not_covered[] = {
        {!packing.bars.empty(), "clumps"},
        {packing.cell.keeps_shape, "isotropic cells"},
        {state.load.path.has_value(), "paths in stress space"},
        {state.load.kind != LoadKind::nominal, "true stresses"},
        {rows.size() != coordinates_of(packing), "packings that are not isostatic"},
        {claims.gaps && !std::isfinite(claims.gaps->smallest), "packings without a pair that does not touch"},
        {!claims.vertex || !claims.forces || !claims.gaps || !claims.load_interval,
         "certificates without one of the claims vertex, forces, gaps, load interval"},
        {packing.cell.any() && claims.forces && !pinned_disk_bears_force(state, *claims.forces),
         "cells whose pinned disk bears no force"},
    };
    for (const auto& [found, what] : not_covered) {
        if (found) {
            throw Undecided(std::string("the checker in Coq does not cover ") + what);
        }
    }
}

void write_certificate(const State& state, const CertificateClaims& claims) {
    const Packing& packing = state.packing;
    const std::vector<Contact> rows = rows_of(state);
    require_covered(state, claims, rows);
    const Vertex v = vertex_of(packing, rows, claims.vertex->unique_radius);
    ForcesClaim forces = *claims.forces;
    forces.finite.resize(rows.size()); // nothing is claimed of what is held
    std::vector<bool> zeros(rows.size(), false);
    std::vector<Interval> infinitesimal(rows.size());
    for (std::size_t k = 0; k < forces.structural_zeros.size(); ++k) {
        const std::size_t l = Integers::index(forces.structural_zeros[k]);
        zeros[l] = true;
        infinitesimal[l] = forces.infinitesimal[k];
    }
    const ForceUnits units = force_units(state, claims, infinitesimal);
    const Numbers load = finite_load(state, units.force);
    const Numbers rate = unit_load(state, units.force - units.stress);
    Numbers small_load = multiples(state.load.infinitesimal, units.small);
    small_load.resize(rows.size());
    const Number zoom = power_of_two(zoom_exponent);
    const Integers small = enlarged(v.packing, zoom);
    const Approximate system(small, v.refined);
    const auto solved = [&](const Numbers& any) {
        return quotients(small, v.refined, any, system, v.error, v.stiffness * zoom);
    };
    const Quotients finite = solved(load);
    const Quotients slopes = solved(rate);

    write_vertex(v, packing);
    std::printf(
        "(* The units are 2 to these powers: of lengths, of refined lengths, of forces, of infinitesimal ones, of "
        "stresses. *)\nDefinition exponents : seq Z := [:: %d; %d; %d; %d; %d].\n",
        v.unit, v.fine, units.force, units.small, units.stress);
    write_forces("the_forces", load, finite, forces.finite, units.force);
    write_forces("the_infinitesimal_forces", small_load, solved(small_load), infinitesimal, units.small);
    std::printf("Definition the_rate : force_solution := ");
    write_solution(rate, slopes);
    std::printf(".\n");
    const EndWriter ends{state, v, load, finite, rate, slopes, zeros, units.stress};
    ends.write("the_lower_end", claims.load_interval->low, -1);
    ends.write("the_upper_end", claims.load_interval->high, 1);
    std::printf("Definition the_certificate : load_certificate := {|\n  equilibrium := {|\n  vertex := the_vertex;\n"
                "  finite := the_forces;\n  infinitesimal := the_infinitesimal_forces;\n  zeros := %s;\n"
                "  unloaded := %s;\n  gap := %s |};\n",
                list(zeros).c_str(), list(unloaded_by(v, load, zeros)).c_str(),
                rounded(std::ceil(std::ldexp(claims.gaps->smallest, -v.fine))).text().c_str());
    std::printf(
        "  rate := the_rate;\n  stress := %s;\n  lower_end := the_lower_end;\n  upper_end := the_upper_end |}.\n",
        multiples({state.load.loaded_stress()}, units.stress)[0].text().c_str());
}

State prepared(int disks, std::uint64_t seed) {
    PreparationOptions options;
    options.disks = disks;
    options.seed = seed;
    PreparationReport report;
    auto state = prepare(options, report);
    if (!state.ok()) {
        throw Error(ErrorKind::bad_input, state.failure().message());
    }
    return state.value();
}

} // namespace

int main(int argc, char** argv) {
    try {
        const int disks = argc > 1 ? std::atoi(argv[1]) : 8;
        if (disks > 0) {
            const State state = prepared(disks, argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
            write_certificate(state, certify(state).claims);
        } else {
            const Certificate certificate = read_certificate(argv[1]);
            write_certificate(certificate.state, certificate.claims);
        }
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return error.exit_status();
    } catch (const Undecided& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
    return 0;
}
