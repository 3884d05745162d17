(** Forgeries of one certificate, one number, flag or contact each: compiled by check_certificates.sh beside the data.

    A number is changed by more than the certificate leaves room for. Intervals are changed where they are used. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From Isostat Require Import contact_certificate box_certificate equilibrium_certificate.
Require Data.certificate.
Set Implicit Arguments.
Unset Strict Implicit.
Open Scope Z_scope.

Definition c : equilibrium_certificate := Data.certificate.the_certificate.
Definition v := vertex c.

(** The certificate with other lists, scalars, flags, contacts and rows of L. *)
Definition rebuilt (lists : seq (seq Z)) (scalars : seq Z) (flags : seq (seq bool)) (touching : seq contact)
    (rows : seq (seq (Z * Z))) : equilibrium_certificate :=
  let l := nth [::] lists in let s := nth 0 scalars in
  EquilibriumCertificate
    (VertexCertificate (disks v) touching (l 0%N) (l 1%N) (s 0%N) (s 1%N) (l 2%N) (s 2%N) (s 3%N) (s 4%N) (s 5%N) (s 6%N) rows)
    (ForceClaim (l 3%N) (l 4%N) (l 5%N) (s 7%N) (l 6%N) (s 8%N))
    (ForceClaim (l 7%N) (l 8%N) (l 9%N) (s 9%N) (l 10%N) (s 10%N))
    (nth [::] flags 0) (nth [::] flags 1) (s 11%N).
Definition force_lists (p : force_claim) : seq (seq Z) := [:: load p; low p; high p; quotients p].
Definition lists : seq (seq Z) := [:: stored v; radii v; refined v] ++ force_lists (finite c) ++ force_lists (infinitesimal c).
Definition scalars : seq Z := [:: weight v; zoom v; error v; distance v; ball v; stiffness v; shift v;
  fraction (finite c); slack (finite c); fraction (infinitesimal c); slack (infinitesimal c); gap c].
Definition flags : seq (seq bool) := [:: zeros c; unloaded c].

(** All lists that differ from l in one place, there by f. *)
Definition changed (T : Type) (f : nat -> T -> T) (l : seq T) : seq (seq T) :=
  match l with
  | [::] => [::]
  | x :: _ => [seq set_nth x l k (f k (nth x l k)) | k <- iota 0 (size l)]
  end.
Definition genuine := rebuilt lists scalars flags (contacts v) (factor v).
Definition with_list (k : nat) (l : seq Z) := rebuilt (set_nth [::] lists k l) scalars flags (contacts v) (factor v).
Definition in_list (k : nat) (f : nat -> Z -> Z) : seq equilibrium_certificate :=
  [seq with_list k l | l <- changed f (nth [::] lists k)].

(** Intervals of forces that are used are moved beyond their own other end; the others stay out of this. *)
Definition used (zero : bool) : seq nat := [seq l <- iota 0 (size (zeros c)) | zero_at c l == zero].
Definition moved (k : nat) (p : force_claim) (zero : bool) : seq equilibrium_certificate :=
  [seq with_list k (set_nth 0 (low p) l (nth 0 (high p) l + 1)) | l <- used zero]
  ++ [seq with_list k.+1 (set_nth 0 (high p) l (nth 0 (low p) l - 1)) | l <- used zero].

Definition root : Z := 2 * Z.sqrt (shift v) + 2.
Definition away (x : Z) : Z := if x <? 0 then x - root else x + root.
Definition forged_rows : seq equilibrium_certificate :=
  flatten [seq [seq rebuilt lists scalars flags (contacts v) (set_nth [::] (factor v) k row)
    | row <- changed (fun _ e => (e.1, away e.2)) (nth [::] (factor v) k)] | k <- iota 0 (size (factor v))].

Definition next (l : nat) : contact := nth (Lower 0 0) (contacts v) (if l is l'.+1 then l' else 1).
Definition forged_contacts : seq equilibrium_certificate :=
  [seq rebuilt lists scalars flags l (factor v)
    | l <- changed (fun l _ => next l) (contacts v) ++ changed (fun _ _ => Lower 0 2) (contacts v)].

Definition bad_scalar (k : nat) (x : Z) : Z :=
  match k with
  | 2 | 3 | 6 | 8 | 10 => Z0       (* error, distance, shift and slacks: nothing is granted *)
  | 11 => Z.add (Z.add x 1) (Z.div x 64) (* the gap *)
  | 1 => Z.succ x                  (* zoom *)
  | 0 | 7 | 9 => Z.double x        (* weight and fractions *)
  | _ => Z.mul 1000 x              (* ball and stiffness *)
  end%N.
Definition forgeries : seq equilibrium_certificate :=
  in_list 0 (fun _ x => x + 2 * ball v) ++ in_list 1 (fun _ x => x + 1) ++ in_list 2 (fun _ x => x + 64 * error v)
  ++ in_list 3 (fun _ x => x + 1) ++ in_list 7 (fun _ x => x + 1)
  ++ in_list 6 (fun _ x => x + 64 * slack (finite c)) ++ in_list 10 (fun _ x => x + 64 * slack (infinitesimal c))
  ++ moved 4 (finite c) false ++ moved 8 (infinitesimal c) true
  ++ [seq rebuilt lists s flags (contacts v) (factor v) | s <- changed bad_scalar scalars]
  ++ [seq rebuilt lists scalars (set_nth [::] flags 0 f) (contacts v) (factor v) | f <- changed (fun _ => negb) (zeros c)]
  ++ [seq rebuilt lists scalars (set_nth [::] flags 1 f) (contacts v) (factor v) | f <- changed (fun _ => negb) (unloaded c)]
  ++ forged_contacts ++ forged_rows.

Lemma rebuilding_changes_nothing : equilibrium_check genuine = true.
Proof. vm_cast_no_check (erefl true). Qed.
Lemma every_forgery_is_refused : all (fun f => ~~ equilibrium_check f) forgeries = true.
Proof. vm_cast_no_check (erefl true). Qed.
Eval vm_compute in size forgeries.
