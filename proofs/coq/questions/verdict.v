(** What Coq says of one certificate: compiled by check_certificates.sh, not by make, beside the data.

    The file with the data is not trusted: it is neither read for notations nor asked for a proof. What was proved is
    printed at the end, field by field, so that compare.py can lay it beside the certificate of the program. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From Isostat Require Import contact_certificate max_norm box_certificate equilibrium_certificate load_certificate.
Require Data.certificate.

Definition whole : load_certificate := Data.certificate.the_certificate.
Definition c : equilibrium_certificate := equilibrium whole.

Lemma accepted : load_check whole = true.
Proof. vm_cast_no_check (erefl true). Qed.

Theorem packing_is_in_equilibrium (F : archiFieldType) : complete F -> certified F whole.
Proof. move=> full; exact: equilibrium_with_its_interval full accepted. Qed.

Print Assumptions packing_is_in_equilibrium.
Set Printing Depth 1000000.
Eval vm_compute in (Data.certificate.exponents : seq Z).
Eval vm_compute in (lies_in (vertex c) : nat).
Eval vm_compute in disks (vertex c).
Eval vm_compute in contacts (vertex c).
Eval vm_compute in walls (vertex c).
Eval vm_compute in periodic (vertex c).
Eval vm_compute in stored (vertex c).
Eval vm_compute in radii (vertex c).
Eval vm_compute in zoom (vertex c).
Eval vm_compute in distance (vertex c).
Eval vm_compute in ball (vertex c).
Eval vm_compute in load (finite c).
Eval vm_compute in low (finite c).
Eval vm_compute in high (finite c).
Eval vm_compute in zeros c.
Eval vm_compute in load (infinitesimal c).
Eval vm_compute in low (infinitesimal c).
Eval vm_compute in high (infinitesimal c).
Eval vm_compute in gap c.
Eval vm_compute in load (rate whole).
Eval vm_compute in stress whole.
Eval vm_compute in seq_of_opt (opens (lower_end whole)).
Eval vm_compute in [:: near (lower_end whole); far (lower_end whole)].
Eval vm_compute in seq_of_opt (opens (upper_end whole)).
Eval vm_compute in [:: near (upper_end whole); far (upper_end whole)].
