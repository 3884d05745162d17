#pragma once
/// \file
/// Every public header of the library. Each can be
/// included alone; include/README.md says what each holds.

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>
#include <isostat/compare/compare.hpp>
#include <isostat/contact/state.hpp>
#include <isostat/core/contact.hpp>
#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>
#include <isostat/crafted/exact_packing.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/exact/number.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/io/run_directory.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/motion/arc_certificate.hpp>
#include <isostat/packing/load.hpp>
#include <isostat/packing/packing.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/rigidity/counting.hpp>
#include <isostat/scene/scene.hpp>
#include <isostat/snap/snap.hpp>
#include <isostat/statics/rules.hpp>
#include <isostat/trajectory/records.hpp>
#include <isostat/trajectory/trajectory.hpp>
