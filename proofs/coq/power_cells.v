(** Statement T5 (../contact_candidates.md): the argument with power cells, in the plane over a real closed field.

    A disk is a centre and a radius >= 0. [inside i x] says that x belongs to the power cell of disk i among all
      disks. The regular
    triangulation enters through one hypothesis, which holds when no vertex is hidden: the cell of i is cut out by the
      edges of i alone. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Plane.
Variable F : rcfType.
Definition point := (F * F)%type.
Definition dist2 (x y : point) : F := (x.1 - y.1) ^+ 2 + (x.2 - y.2) ^+ 2.
Definition power (c : point) (r : F) (x : point) : F := dist2 x c - r ^+ 2.

(** Two disks do not overlap: the distance of the centres is at least the sum of the radii. *)
Definition apart (c : point) (r : F) (c' : point) (r' : F) := (r + r') ^+ 2 <= dist2 c c'.

Lemma dist2_ge0 x y : 0 <= dist2 x y.
Proof. by rewrite addr_ge0 ?sqr_ge0. Qed.

Lemma dist2_sym x y : dist2 x y = dist2 y x.
Proof. by rewrite /dist2; ring. Qed.

Lemma dist2_eq0 x y : dist2 x y = 0 -> x = y.
Proof.
move/eqP; rewrite paddr_eq0 ?sqr_ge0 // !sqrf_eq0 !subr_eq0.
by case: x y => [a b] [c d] /= /andP[/eqP-> /eqP->].
Qed.

(** If i and j do not overlap, disk i lies on its own side of their radical axis. *)
Lemma disk_on_its_side (c c' x : point) (r r' : F) :
  0 <= r -> 0 <= r' -> apart c r c' r' -> dist2 x c <= r ^+ 2 -> power c r x <= power c' r' x.
Proof.
move=> r0 r'0 away inx.
set d := Num.sqrt (dist2 c c').
have d0 : 0 <= d := sqrtr_ge0 _.
have d2 : d ^+ 2 = dist2 c c' by rewrite sqr_sqrtr ?dist2_ge0.
have rd : r + r' <= d by rewrite -(@ler_pexpn2r _ 2) ?nnegrE ?addr_ge0 // d2.
(* Cauchy-Schwarz: y.d <= r |d| with y = x - c. *)
set s := (x.1 - c.1) * (c'.1 - c.1) + (x.2 - c.2) * (c'.2 - c.2).
have sle : s <= r * d.
  case: (lerP s 0) => [sn|sp]; first by rewrite (le_trans sn) ?mulr_ge0.
  rewrite -(@ler_pexpn2r _ 2) ?nnegrE ?mulr_ge0 ?(ltW sp) // exprMn d2.
  apply: le_trans (ler_wpmul2r (dist2_ge0 c c') inx).
  rewrite -subr_ge0.
  have -> : dist2 x c * dist2 c c' - s ^+ 2
     = ((x.1 - c.1) * (c'.2 - c.2) - (x.2 - c.2) * (c'.1 - c.1)) ^+ 2.
    by rewrite /dist2 /s; ring.
  exact: sqr_ge0.
rewrite -subr_ge0.
have -> : power c' r' x - power c r x = d ^+ 2 - 2%:R * s + r ^+ 2 - r' ^+ 2.
  by rewrite d2 /power /dist2 /s; ring.
have -> : d ^+ 2 - 2%:R * s + r ^+ 2 - r' ^+ 2 = 2%:R * (r * d - s) + (d - r - r') * (d - r + r') by ring.
apply: addr_ge0; first by rewrite mulr_ge0 ?ler0n ?subr_ge0.
apply: mulr_ge0; first by rewrite -addrA -opprD subr_ge0.
by rewrite addr_ge0 // subr_ge0 (le_trans _ rd) // ler_addl.
Qed.

(** If each of two disks with different centres lies in its own cell against the other, they do not overlap. *)
Lemma apart_from_cells (c c' : point) (r r' : F) :
  0 <= r -> 0 <= r' -> c <> c' ->
  (forall x, dist2 x c <= r ^+ 2 -> power c r x <= power c' r' x) ->
  (forall x, dist2 x c' <= r' ^+ 2 -> power c' r' x <= power c r x) ->
  apart c r c' r'.
Proof.
move=> r0 r'0 ne cell cell'.
set d := Num.sqrt (dist2 c c').
have d0 : 0 < d.
  rewrite lt_neqAle sqrtr_ge0 andbT eq_sym; apply/eqP => dz; apply: ne; apply: dist2_eq0.
  by rewrite -(sqr_sqrtr (dist2_ge0 c c')) -/d dz expr0n.
have d2 : d ^+ 2 = dist2 c c' by rewrite sqr_sqrtr ?dist2_ge0.
have dn : d != 0 by rewrite gt_eqF.
have far (a b : point) (ra rb : F) : dist2 a b = d ^+ 2 ->
    (forall x, dist2 x a <= ra ^+ 2 -> power a ra x <= power b rb x) -> rb ^+ 2 <= (d - ra) ^+ 2.
  move=> dab cl.
  pose x : point := (a.1 + ra / d * (b.1 - a.1), a.2 + ra / d * (b.2 - a.2)).
  have E1 : dist2 x a = ra ^+ 2.
    have -> : dist2 x a = (ra / d) ^+ 2 * dist2 a b by rewrite /dist2 /=; ring.
    by rewrite dab -exprMn divfK.
  have E2 : dist2 x b = (d - ra) ^+ 2.
    have -> : dist2 x b = (1 - ra / d) ^+ 2 * dist2 a b by rewrite /dist2 /=; ring.
    by rewrite dab -exprMn mulrBl mul1r divfK.
  have := cl x; rewrite /power E1 E2 subrr lexx => /(_ isT).
  by rewrite subr_ge0.
have f1 := far c c' r r' (esym d2) cell.
have f2 : r ^+ 2 <= (d - r') ^+ 2 by apply: far cell'; rewrite dist2_sym d2.
rewrite /apart -d2 ler_pexpn2r ?nnegrE ?addr_ge0 ?(ltW d0) //.
case: (lerP (r + r') d) => // lt.
(* r' <= |d - r| and r <= |d - r'|, r + r' > d: both differences are non-positive, hence d <= 0. *)
have g1 : d + r' <= r.
  rewrite -subr_ge0 in f1; have : 0 <= (d - r - r') * (d - r + r') by move: f1; rewrite subr_sqr.
  rewrite nmulr_rge0; last by rewrite -addrA -opprD subr_lt0.
  by rewrite addrAC subr_le0.
have g2 : d + r <= r'.
  rewrite -subr_ge0 in f2; have : 0 <= (d - r' - r) * (d - r' + r) by move: f2; rewrite subr_sqr.
  rewrite nmulr_rge0; last by rewrite -addrA -opprD subr_lt0 addrC.
  by rewrite addrAC subr_le0.
have : d + (d + r) <= r by apply: le_trans g1; rewrite ler_add2l.
by rewrite addrA -ler_subr_addr subrr leNgt addr_gt0.
Qed.

(** T5. *)
Section Triangulation.
Variables (n : nat) (c : 'I_n -> point) (r : 'I_n -> F) (edge : rel 'I_n).
Definition inside (i : 'I_n) (x : point) := forall k, power (c i) (r i) x <= power (c k) (r k) x.

Hypothesis radius_ge0 : forall i, 0 <= r i.
Hypothesis distinct : injective c.
Hypothesis cells_are_local :
  forall i x, (forall j, edge i j -> power (c i) (r i) x <= power (c j) (r j) x) -> inside i x.

Theorem no_overlapping_edge_no_overlap :
  (forall i j, edge i j -> apart (c i) (r i) (c j) (r j)) ->
  forall i k, i != k -> apart (c i) (r i) (c k) (r k).
Proof.
move=> edges i k ne.
have own a x : dist2 x (c a) <= r a ^+ 2 -> inside a x.
  by move=> inx; apply: cells_are_local => j /edges away; apply: disk_on_its_side.
apply: apart_from_cells => //.
- by move=> /distinct E; rewrite E eqxx in ne.
- by move=> x /own; apply.
- by move=> x /own; apply.
Qed.
End Triangulation.
End Plane.

Print Assumptions no_overlapping_edge_no_overlap.
