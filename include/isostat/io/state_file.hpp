#pragma once
/// \file
/// Files of states and of certificates.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace isostat {

/// The content of a state file.
struct StateFile {
    State state;
    std::vector<double>
        forces; ///< empty, or f0 of every contact of the state: used for pictures, never as the start of a computation
};

/// The JSON text of a state (format "isostat-state", version 2): packing, load, contacts, provenance, and forces when
/// given (one per contact). Doubles are written in a short form that reads back to the same bits. Rows are one per
/// line. Throws `Error(bad_input)` naming the field when a number is not finite.
std::string state_text(const State& state, std::span<const double> forces = {});

/// Writes `state_text` atomically. Throws `Error(cannot_write)`.
void write_state(const std::filesystem::path& path, const State& state, std::span<const double> forces = {});

/// Writes where a failed preparation stopped, for pictures: format "isostat-packing", disks and box only, with the
/// reason. No command reads this format as a state. Throws `Error(cannot_write)`.
void write_packing(const std::filesystem::path& path, const Packing& packing, const std::string& reason);

/// Reads a state from text; `source` (a file name) starts every message. Numbers may also be strings with a hexadecimal
/// float. Throws `Error(bad_input)` with file, field, value and what was expected: text that is not complete JSON,
/// unknown or missing fields, numbers that are not finite, radii that are not positive, disks larger than the box,
/// contacts out of range, of a disk with itself or given twice. Gaps, overlaps and the number of contacts are not
/// checked here: see `check_start`. A periodic cell is refused, because most of the program takes boxes only.
StateFile parse_state(const std::string& text, const std::string& source);

/// Spheres are refused by what takes disks only, which says so (`require_plane`), and clumps by what takes single
/// grains only (`require_single_grains`): `any_clumps` takes unions of disks, `any_bodies` those bounded by arcs too.
enum class Dimensions : unsigned char { two, any, any_clumps, any_bodies };

/// The same, periodic cells too. Further messages: walls along a periodic axis, images in a box or more than 3 periods
/// away, periods that are not positive, disks that overlap their own images, loads that do not sum to zero along a
/// periodic axis.
StateFile parse_any_state(const std::string& text, const std::string& source, Dimensions dimensions = Dimensions::two);

/// Reads a state file or, recognised by its first character, a vertex text (`vertex_text.hpp`).
StateFile read_state(const std::filesystem::path& path);
StateFile read_any_state(const std::filesystem::path& path, Dimensions dimensions = Dimensions::two);

/// The exact value lies in [lower, upper]; the ends may be infinite, never NaN.
struct Interval {
    double lower = 0;
    double upper = 0;
    friend bool operator==(const Interval&, const Interval&) = default;
};

/// N_f, N, rank of H, h = N - rank, k = N_f - rank, of the *stored* coordinates as rational numbers and, if
/// `CertificateClaims::vertex` is claimed too, of the true vertex.
struct CountingClaim {
    int dof_count = 0;
    int contact_count = 0;
    int rank = 0;
    int hyperstaticity = 0;
    int hypostaticity = 0;
    Rung rung = Rung::exact;
};

/// There is a configuration q* with |q*_i - q_i| <= radius for every coordinate, at which the gap of every contact is
/// exactly 0; no other one has |q_i - q'_i| <= unique_radius for every coordinate (radius <= unique_radius). This q* is
/// the *true vertex* of which the other claims speak.
struct VertexClaim {
    double radius = 0;
    double unique_radius = 0;
    Rung rung = Rung::double_bound;
};

/// Forces at the true vertex under the load of the state, compressive positive, one per contact in the state's order.
/// Forces listed in `structural_zeros` are exactly 0 there for combinatorial reasons: some set of degrees of freedom
/// without finite load is touched by exactly as many contacts, all of them listed. Their signs are decided by
/// infinitesimal forces (per unit of eps, same order as the list). Claimed to lie in intervals above 0 are all finite
/// forces of contacts that are no structural zeros, and all infinitesimal forces of listed contacts; bars and held
/// coordinates are structural zeros or bear a force of any sign.
struct ForcesClaim {
    std::vector<Interval> finite;
    std::vector<int> structural_zeros; ///< increasing positions in the contact list
    std::vector<Interval> infinitesimal;
    Rung rung = Rung::double_bound;
};

/// Every pair of grains that is not a contact (and can move relative to each other)
/// has a gap >= `smallest` > 0 at the true vertex; `where` is the nearest pair, or
/// one whose gap is as small up to 2^-46 of the largest coordinate or radius.
/// Without any such pair `smallest` is infinite and `where` is not written.
struct GapsClaim {
    double smallest = 0;
    Contact where;
    Rung rung = Rung::double_bound;
};

/// One end of the interval of the loaded stress within which all finite forces stay >= 0 at the true vertex: force
/// `opens` vanishes there. `unbounded`: no force decreases in this direction.
struct LoadEndClaim {
    bool unbounded = false;
    Interval stress;
    Contact opens; ///< where several forces vanish together for structural reasons: one of their contacts
};

/// The supported interval of the loaded stress.
struct LoadIntervalClaim {
    LoadEndClaim low;
    LoadEndClaim high;
    Rung rung = Rung::double_bound;
};

/// For clumps with mechanisms on which the load acts. An equilibrium exists with no coordinate
/// farther than `away` from the stored one: the listed contacts and bars are closed, all contacts
/// bear positive forces, no held coordinate bears a multiplier, and no other pair touches. There the
/// potential of the load has a strict local minimum, except for motions that change no force: d2W is
/// at least `curvature` times |dc|^2, c the held coordinates on which the load acts (statement U8); under true stresses
/// that of the product of the lengths there times their potential. The form d2W itself, at the stored values of `held`,
/// is in `form`, whose matrices all have no eigenvalue below `curvature`.
struct MinimumClaim {
    double away = 0;
    double curvature = 0;
    std::vector<Contact> held{};  ///< the coordinates c, in the order of the contacts of the state
    std::vector<Interval> form{}; ///< rows of the upper triangle; entry ij is of the velocities that move c_i, or c_j,
                                  ///< at the rate 1, and no other row
};

/// The claims of a certificate. An absent claim was not proved; `undecided` says why. When all are there, the true
/// vertex is an isostatic equilibrium without overlap, and a strict local minimum of the potential of the load
/// (`stable`; statement T8: all forces positive and no mechanism).
struct CertificateClaims {
    std::optional<CountingClaim> counting;
    std::optional<VertexClaim> vertex;
    std::optional<ForcesClaim> forces;
    std::optional<GapsClaim> gaps;
    std::optional<LoadIntervalClaim> load_interval;
    bool stable = false;
    std::optional<MinimumClaim> minimum; ///< instead of all others: h = 0, and k is not 0
    std::vector<std::string> undecided;  ///< one sentence per claim that is absent
};

/// A certificate: claims about one state.
struct Certificate {
    State state;            ///< the input, complete: a checker needs nothing else
    std::string input;      ///< name of the input file, for people
    std::string input_hash; ///< SHA-256 of that file's bytes, in hexadecimal
    std::string program;    ///< name and version of the program that claims
    CertificateClaims claims;
};

/// SHA-256 in hexadecimal (64 digits).
std::string sha256(const std::string& bytes);

/// The JSON text of a certificate (format "isostat-certificate", version 1): the state as in a state file, the claims
/// (null where absent), and `digest`, the SHA-256 of the same JSON without that field, dumped without white space and
/// with sorted keys. Infinite ends of intervals are the strings "inf" and "-inf". Throws `Error(bad_input)` when a
/// number is NaN, or infinite where it must not be, or an interval has its ends in the wrong order.
std::string certificate_text(const Certificate& certificate);

/// Reads what `certificate_text` wrote; `source` (a file name) starts every message. Throws `Error(bad_input)` with
/// file, field, value and what was expected: unknown, missing or repeated fields, lists of the wrong length, NaN,
/// intervals whose ends are in the wrong order, and a digest that does not belong to the content. Claims are not proved
/// again here; only the signs of counts, radii and the smallest gap are checked.
Certificate parse_certificate(const std::string& text, const std::string& source);

/// Reads a certificate file. Throws `Error(bad_input)`.
Certificate read_certificate(const std::filesystem::path& path);

/// Writes `certificate_text` atomically. Throws `Error(cannot_write)`.
void write_certificate(const std::filesystem::path& path, const Certificate& certificate);

/// The format of a text from its content alone, or empty: "state", "vertex", "packing" are formats of this program
/// (`read_state`, `crafted::read_packing`), the others those of `read_foreign`.
std::string recognise_format(const std::string& text);

} // namespace isostat
