#pragma once
/// \file
/// Signs along a tube: of the gaps of all pairs (proofs/checker.md, K19), and of the power of the load (K20).

#include "checker/tube.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace isostat::checker {

/// How the gap of a pair was on the last stretch; pairs without an entry were above 0.
enum class Course : unsigned char { zero, rising, falling };

class GapCourses {
  public:
    /// `watched`: the pairs to check; nothing: every pair except the kept contacts.
    GapCourses(const Moving& moving, const std::vector<Contact>& contacts, const Contact& opened,
               std::optional<std::vector<Contact>> watched = {});
    /// Checks these pairs for s in [from, to] on a tube. False: neither the sign of a gap nor that of its rate was
    /// proved; `trouble()` says where.
    bool look(const Tube& tube, double from, double to);
    [[nodiscard]] bool falls(const Contact& pair) const;
    [[nodiscard]] const std::string& trouble() const { return trouble_; }

  private:
    struct Motion;
    bool look(const Tube& tube, const Contact& pair, double from, double to);
    bool walk(const Motion& motion, double from, double to, int depth, std::optional<Course>& last);
    [[nodiscard]] std::vector<double> ways(const Tube& tube, double h) const;
    [[nodiscard]] std::optional<std::vector<Contact>> near_disks(const Tube& tube,
                                                                 const std::vector<double>& way) const;
    [[nodiscard]] std::optional<std::vector<Contact>> near_images(const Tube& tube,
                                                                  const std::vector<double>& way) const;
    [[nodiscard]] std::vector<Contact> near_walls(const Tube& tube, const std::vector<double>& way) const;

    const Moving& moving_;
    std::set<Contact> kept_;
    std::vector<int> body_; ///< body of each disk
    std::optional<std::vector<Contact>> watched_;
    std::map<Contact, Course> last_;
    std::string trouble_;
};

/// The load along the arc.
struct Pushing {
    std::vector<Bounds> fixed; ///< per coordinate
    /// True stresses: the force on the upper wall of an axis also has minus this times the lengths of the other axes.
    PerAxis<double> pressure{};
};

/// Whether F . q' is positive for all s in [from, to].
bool power_is_positive(const Pushing& load, const Moving& moving, const Tube& tube, double from, double to);

} // namespace isostat::checker
