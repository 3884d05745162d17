(** Forgeries of one certificate, one number, flag or contact each: compiled by check_certificates.sh beside the data.

    A number is changed by more than the certificate leaves room for. Intervals are changed where they are used. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From Isostat Require Import contact_certificate box_certificate equilibrium_certificate load_certificate.
Require Data.certificate.
Set Implicit Arguments.
Unset Strict Implicit.
Open Scope Z_scope.

Section Forgeries.
Variable whole : load_certificate.
Definition c : equilibrium_certificate := equilibrium whole.
Definition v := vertex c.

(** The certificate in another dimension, with other lists, scalars, flags, contacts, rows of L, and contacts that open. *)
Definition rebuilt_in (d : dimension) (lists : seq (seq Z)) (scalars : seq Z) (flags : seq (seq bool)) (touching : seq contact)
    (rows : seq (seq (Z * Z))) (opening : seq (option nat)) : load_certificate :=
  let l := nth [::] lists in let s := nth 0 scalars in let f := nth [::] flags in let o := nth None opening in
  LoadCertificate
    (EquilibriumCertificate
      (VertexCertificate d (disks v) touching (f 6%N) (f 7%N) (l 0%N) (l 1%N) (s 0%N) (s 1%N) (l 2%N) (s 2%N) (s 3%N) (s 4%N) (s 5%N) (s 6%N) rows)
      (ForceClaim (ForceSolution (l 3%N) (s 7%N) (l 6%N) (s 8%N)) (l 4%N) (l 5%N))
      (ForceClaim (ForceSolution (l 7%N) (s 9%N) (l 10%N) (s 10%N)) (l 8%N) (l 9%N))
      (f 0%N) (f 1%N) (s 11%N))
    (ForceSolution (l 11%N) (s 12%N) (l 12%N) (s 13%N)) (s 14%N)
    (LoadEnd (o 0%N) (f 2%N) (f 3%N) (s 15%N) (s 16%N)) (LoadEnd (o 1%N) (f 4%N) (f 5%N) (s 17%N) (s 18%N)).
Definition rebuilt := rebuilt_in (lies_in v).
Definition force_lists (p : force_claim) : seq (seq Z) := [:: load p; low p; high p; quotients p].
Definition lists : seq (seq Z) := [:: stored v; radii v; refined v] ++ force_lists (finite c)
  ++ force_lists (infinitesimal c) ++ [:: load (rate whole); quotients (rate whole)].
Definition below := lower_end whole.
Definition above := upper_end whole.
Definition scalars : seq Z := [:: weight v; zoom v; error v; distance v; ball v; stiffness v; shift v;
  fraction (finite c); slack (finite c); fraction (infinitesimal c); slack (infinitesimal c); gap c;
  fraction (rate whole); slack (rate whole); stress whole; near below; far below; near above; far above].
Definition flags : seq (seq bool) := [:: zeros c; unloaded c; mute below; free below; mute above; free above; walls v; periodic v].
Definition opening : seq (option nat) := [:: opens below; opens above].

(** All lists that differ from l in one place, there by f. *)
Definition changed (T : Type) (f : nat -> T -> T) (l : seq T) : seq (seq T) :=
  match l with
  | [::] => [::]
  | x :: _ => [seq set_nth x l k (f k (nth x l k)) | k <- iota 0 (size l)]
  end.
Definition genuine := rebuilt lists scalars flags (contacts v) (factor v) opening.
Definition with_list (k : nat) (l : seq Z) := rebuilt (set_nth [::] lists k l) scalars flags (contacts v) (factor v) opening.
Definition in_list (k : nat) (f : nat -> Z -> Z) : seq load_certificate :=
  [seq with_list k l | l <- changed f (nth [::] lists k)].

(** A wall that is touched is said to be none. Without contacts it may be: less is claimed then. Along a periodic axis
    there is said to be one. *)
Definition touched (k : nat) : bool :=
  has (fun d => match d with Lower _ a => a == k | Upper _ a => lies_in v + a == k | _ => false end)%N (contacts v).

(** Intervals of forces that are used are moved beyond their own other end; the others stay out of this. *)
Definition used (zero : bool) : seq nat := [seq l <- iota 0 (size (zeros c)) | (zero_at c l == zero) && ~~ held_at c l].
Definition moved (k : nat) (p : force_claim) (zero : bool) : seq load_certificate :=
  [seq with_list k (set_nth 0 (low p) l (nth 0 (high p) l + 1)) | l <- used zero]
  ++ [seq with_list k.+1 (set_nth 0 (high p) l (nth 0 (low p) l - 1)) | l <- used zero].

(** A load that the residual has no room for. *)
Definition more_load (p : force_solution) (_ : nat) (x : Z) : Z := x + 2 * (fine_stiffness v * slack p) / fraction p + 1.

Definition root : Z := 2 * Z.sqrt (shift v) + 2.
Definition away (x : Z) : Z := if x <? 0 then x - root else x + root.
Definition forged_rows : seq load_certificate :=
  flatten [seq [seq rebuilt lists scalars flags (contacts v) (set_nth [::] (factor v) k row) opening
    | row <- changed (fun _ e => (e.1, away e.2)) (nth [::] (factor v) k)] | k <- iota 0 (size (factor v))].

Definition next (l : nat) : contact := nth (Lower 0 0) (contacts v) (if l is l'.+1 then l' else 1).
Definition another_image (a : nat) (_ : nat) (d : contact) : contact :=
  if d is Image i j k l m then match a with
    | 0%N => Image i j (k + 1) l m | 1%N => Image i j k (l + 1) m | _ => Image i j k l (m + 1) end else Lower 0 3.
Definition forged_contacts : seq load_certificate :=
  [seq rebuilt lists scalars flags l (factor v) opening
    | l <- changed (fun l _ => next l) (contacts v)
      ++ flatten [seq changed (another_image a) (contacts v) | a <- iota 0 3]].

(** Another contact is said to open: one that bears a force there. Or none at all; or one where none does. *)
Definition forged_opening : seq load_certificate :=
  [seq rebuilt lists scalars flags (contacts v) (factor v) o
    | o <- changed (fun _ o => if o is Some _ then None else Some 0%N) opening
      ++ [seq set_nth None opening 0 (Some l) | l <- iota 0 (size (contacts v)) & ~~ nth false (mute below) l]
      ++ [seq set_nth None opening 1 (Some l) | l <- iota 0 (size (contacts v)) & ~~ nth false (mute above) l]].

Definition width : Z := Z.abs (far below - near below) + Z.abs (far above - near above) + 1.
Definition bad_scalar (k : nat) (x : Z) : Z :=
  match k with
  | 2 | 3 | 6 | 8 | 10 | 13 => Z0  (* error, distance, shift and slacks: nothing is granted *)
  | 11 => Z.add (Z.add x 1) (Z.div x 64) (* the gap *)
  | 1 => Z.succ x                  (* zoom *)
  | 0 | 7 | 9 | 12 => Z.double x   (* weight and fractions *)
  | 14 => Z.add x width               (* the stress *)
  | 15 => Z.pred (far below)          (* either end of the places of either end: beyond the other *)
  | 16 => Z.succ (near below)
  | 17 => Z.succ (far above)
  | 18 => Z.pred (near above)
  | _ => Z.mul 1000 x              (* ball and stiffness *)
  end%N.
(** An end that is not there has no place, and infinitesimal loads that are 0 are balanced by forces that are. *)
Definition matters (k : nat) : bool :=
  if (k == 9)%N || (k == 10)%N then has (fun x => ~~ (x =? 0)) (load (infinitesimal c)) else if (k < 14)%N then true else if k == 14%N then isSome (opens below) || isSome (opens above)
  else isSome (opens (if (k < 17)%N then below else above)).
Definition forgeries : seq load_certificate :=
  in_list 0 (fun _ x => x + 2 * ball v) ++ in_list 1 (fun _ x => x + 1) ++ in_list 2 (fun _ x => x + 64 * error v)
  ++ in_list 3 (more_load (finite c)) ++ in_list 7 (more_load (infinitesimal c)) ++ in_list 11 (more_load (rate whole))
  ++ in_list 6 (fun _ x => x + 64 * slack (finite c)) ++ in_list 10 (fun _ x => x + 64 * slack (infinitesimal c))
  ++ in_list 12 (fun _ x => x + 64 * slack (rate whole))
  ++ moved 4 (finite c) false ++ moved 8 (infinitesimal c) true
  ++ [seq rebuilt lists (set_nth 0 scalars k (bad_scalar k (nth 0 scalars k))) flags (contacts v) (factor v) opening
    | k <- iota 0 (size scalars) & matters k]
  ++ flatten [seq [seq rebuilt lists scalars (set_nth [::] flags k f) (contacts v) (factor v) opening
    | f <- changed (fun _ => negb) (nth [::] flags k)] | k <- iota 0 6]
  ++ [seq rebuilt lists scalars (set_nth [::] flags 6 (set_nth false (walls v) k (~~ nth false (walls v) k))) (contacts v) (factor v) opening
    | k <- iota 0 (2 * lies_in v) & touched k || nth false (periodic v) (k %% lies_in v)]
  ++ [seq rebuilt lists scalars (set_nth [::] flags 7 f) (contacts v) (factor v) opening | f <- changed (fun _ => negb) (periodic v)]
  ++ forged_contacts ++ forged_rows ++ forged_opening
  ++ [:: rebuilt_in (if lies_in v is Plane then Space else Plane) lists scalars flags (contacts v) (factor v) opening].
End Forgeries.

Definition whole : load_certificate := Data.certificate.the_certificate.
Lemma rebuilding_changes_nothing : load_check (genuine whole) = true.
Proof. vm_cast_no_check (erefl true). Qed.
Lemma every_forgery_is_refused : all (fun f => ~~ load_check f) (forgeries whole) = true.
Proof. vm_cast_no_check (erefl true). Qed.
Eval vm_compute in size (forgeries whole).
