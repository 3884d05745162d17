(** A packing in a box: gaps of contacts as polynomials of the coordinates, and their derivative.

    Coordinates x_0 y_0 x_1 y_1 ... Lx Ly, as in contact_certificate.v. The doubled gap of two disks is
    |x_i - x_j|^2 - (R_i + R_j)^2, that of a disk and a wall is 2 w times their distance, w > 0 a length. Both vanish
    exactly where the grains touch, and no root is needed. A coordinate that does not move is held at its place by a row of its own. The definitions are over any ring: integers are computed
    with, and the statements speak of an ordered field. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
From Isostat Require Import shifted_factor max_norm contact_certificate.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** A row of the packing: two grains that exist, or a coordinate that is held. [walls]: the two lower walls, the two
    upper ones. *)
Definition in_the_packing (n : nat) (walls : seq bool) (c : contact) : bool :=
  well_formed n c && match c with Lower _ a => nth false walls a | Upper _ a => nth false walls (2 + a) | _ => true end.

Section Polynomials.
Variables (R : comRingType) (n : nat) (w : R) (radius place x : nat -> R).

Definition separation (i j a : nat) : R := x (i.*2 + a)%N - x (j.*2 + a)%N.

Definition doubled_gap (c : contact) : R :=
  match c with
  | Disks i j => separation i j 0 * separation i j 0 + separation i j 1 * separation i j 1
      - (radius i + radius j) * (radius i + radius j)
  | Lower i a => (w + w) * (x (i.*2 + a)%N - radius i)
  | Upper i a => (w + w) * (x (n.*2 + a)%N - x (i.*2 + a)%N - radius i)
  | Held k => (w + w) * (x k - place k)
  end.

(** Half the derivative of the doubled gap: coordinates that the contact depends on, with the entries. *)
Definition gradient (c : contact) : seq (nat * R) :=
  match c with
  | Disks i j => [:: ((i.*2 + 0)%N, separation i j 0); ((i.*2 + 1)%N, separation i j 1);
      ((j.*2 + 0)%N, - separation i j 0); ((j.*2 + 1)%N, - separation i j 1)]
  | Lower i a => [:: ((i.*2 + a)%N, w)]
  | Upper i a => [:: ((n.*2 + a)%N, w); ((i.*2 + a)%N, - w)]
  | Held k => [:: (k, w)]
  end.

(** The length that the gradient of the gap is a multiple of: at a contact gradient / scale is the unit normal. *)
Definition scale (c : contact) : R := if c is Disks i j then radius i + radius j else w.
End Polynomials.

Lemma doubled_gap_morphism (R S : comRingType) (phi : {rmorphism R -> S}) n w radius place x c :
  doubled_gap n (phi w) (phi \o radius) (phi \o place) (phi \o x) c = phi (doubled_gap n w radius place x c).
Proof. by case: c => *; rewrite /doubled_gap /separation !(rmorphB, rmorphD, rmorphM). Qed.

Lemma gradient_morphism (R S : comRingType) (phi : {rmorphism R -> S}) n w x c :
  gradient n (phi w) (phi \o x) c = [seq (e.1, phi e.2) | e <- gradient n w x c].
Proof. by case: c => * /=; rewrite /separation /= ?(rmorphN, rmorphB, rmorphD). Qed.

Lemma doubled_gap_ext (R : comRingType) n (w : R) radius place x y c : x =1 y ->
  doubled_gap n w radius place x c = doubled_gap n w radius place y c.
Proof. by move=> xy; case: c => * /=; rewrite /separation !xy. Qed.

Lemma gradient_ext (R : comRingType) n (w : R) x y c : x =1 y -> gradient n w x c = gradient n w y c.
Proof. by move=> xy; case: c => * /=; rewrite /separation ?xy. Qed.

(** Grains touch, in the words of geometry: with squares, as no root is needed. *)
Definition touch (F : realFieldType) (n : nat) (radius place x : nat -> F) (c : contact) : Prop :=
  match c with
  | Disks i j => (x (i.*2)%N - x (j.*2)%N) ^+ 2 + (x (i.*2 + 1)%N - x (j.*2 + 1)%N) ^+ 2 = (radius i + radius j) ^+ 2
  | Lower i a => x (i.*2 + a)%N = radius i
  | Upper i a => x (i.*2 + a)%N + radius i = x (n.*2 + a)%N
  | Held k => x k = place k
  end.

Lemma touch_closes (F : realFieldType) n (w : F) radius place x c : w != 0 ->
  touch n radius place x c <-> doubled_gap n w radius place x c = 0.
Proof.
move=> w0; have ww : w + w != 0 by rewrite -mulr2n mulrn_eq0.
case: c => [i j|i a|i a|k] /=; rewrite ?/separation ?addn0.
- rewrite -!expr2.
  by split=> [->|/eqP]; [rewrite subrr|rewrite subr_eq0 => /eqP].
- split=> [->|/eqP]; first by rewrite subrr mulr0.
  by rewrite mulf_eq0 (negPf ww) subr_eq0 => /eqP.
- split=> [<-|/eqP]; first by rewrite [_ + radius i]addrC addrK subrr mulr0.
  by rewrite mulf_eq0 (negPf ww) -addrA -opprD subr_eq0 => /eqP.
- split=> [->|/eqP]; first by rewrite subrr mulr0.
  by rewrite mulf_eq0 (negPf ww) subr_eq0 => /eqP.
Qed.

Section Box.
Variables (F : realFieldType) (n : nat) (w : F) (radius place : nat -> F) (contacts : seq contact).
Let N := (n.*2.+2)%N.
Implicit Types (p q v : 'cV[F]_N).

(** Coordinate k of a configuration; 0 when there is none. *)
Definition at_ q (k : nat) : F := \sum_(m < N | m == k :> nat) q m 0.
Definition contact_at (l : nat) : contact := nth (Lower 0 0) contacts l.
Definition gaps q : 'cV[F]_N := \col_l (2%:R^-1 * doubled_gap n w radius place (at_ q) (contact_at l)).
Definition derivative q : 'M[F]_N := \matrix_(l, m) \sum_(e <- gradient n w (at_ q) (contact_at l) | e.1 == m) e.2.

Lemma at_add p q k : at_ (p + q) k = at_ p k + at_ q k.
Proof. by rewrite /at_ -big_split; apply: eq_bigr => m _; rewrite mxE. Qed.
Lemma at_scale a q k : at_ (a *: q) k = a * at_ q k.
Proof. by rewrite /at_ mulr_sumr; apply: eq_bigr => m _; rewrite mxE. Qed.
Lemma at_sub p q k : at_ (p - q) k = at_ p k - at_ q k.
Proof. by rewrite at_add -scaleN1r at_scale mulN1r. Qed.
Lemma at_ordinal q (m : 'I_N) : at_ q m = q m 0.
Proof. by rewrite /at_ (bigD1 m) //= big1 ?addr0 // => k /andP[/eqP/ord_inj->]; rewrite eqxx. Qed.
Lemma at_norm q k : `|at_ q k| <= norm q.
Proof.
case: (ltnP k N) => kN; first by rewrite (at_ordinal q (Ordinal kN)) entry_norm.
rewrite /at_ big1 ?normr0 ?norm_ge0 // => m /eqP mk.
by have := ltn_ord m; rewrite mk ltnNge kN.
Qed.

Lemma derivative_entry q v l :
  (derivative q *m v) l 0 = \sum_(e <- gradient n w (at_ q) (contact_at l)) e.2 * at_ v e.1.
Proof.
rewrite mxE; under eq_bigr => m _ do rewrite mxE mulr_suml.
rewrite (exchange_big_dep xpredT) //=; apply: eq_bigr => e _; rewrite /at_ mulr_sumr.
by apply: eq_bigl => m; rewrite eq_sym.
Qed.

Theorem gaps_at_the_middle p q : gaps p - gaps q = derivative (2%:R^-1 *: (p + q)) *m (p - q).
Proof.
have two : 2%:R != 0 :> F by rewrite pnatr_eq0.
apply/colP=> l; rewrite derivative_entry !mxE.
case: (contact_at l) => [i j|i a|i a|k]; rewrite /= /separation !big_cons big_nil /= !(at_sub, at_scale, at_add).
- by move: (at_ p _) (at_ p _) (at_ p _) (at_ p _) (at_ q _) (at_ q _) (at_ q _) (at_ q _) => *; field.
- by move: (at_ p _) (at_ q _) => *; field.
- by move: (at_ p _) (at_ p _) (at_ q _) (at_ q _) => *; field.
- by move: (at_ p _) (at_ q _) => *; field.
Qed.

Let separation_norm v i j a : `|separation (at_ v) i j a| <= 2%:R * norm v.
Proof. by rewrite (le_trans (ler_norm_sub _ _)) // mulr_natl mulr2n ler_add ?at_norm. Qed.

(** K1 (b): entries of the derivative are linear in the configuration. *)
Theorem derivative_is_lipschitz p q v : norm (derivative p *m v - derivative q *m v) <= 8%:R * norm (p - q) * norm v.
Proof.
have bound : 0 <= 8%:R * norm (p - q) * norm v by rewrite !mulr_ge0 ?norm_ge0 ?ler0n.
apply: norm_le => // l; rewrite mxE [X in _ + X]mxE !derivative_entry.
case: (contact_at l) => [i j|i a|i a|k]; rewrite /= !big_cons !big_nil /= ?subrr ?normr0 //.
set u := at_ p; set z := at_ q.
have -> : separation u i j 0 * at_ v (i.*2 + 0) + (separation u i j 1 * at_ v (i.*2 + 1)
    + (- separation u i j 0 * at_ v (j.*2 + 0) + (- separation u i j 1 * at_ v (j.*2 + 1) + 0)))
    - (separation z i j 0 * at_ v (i.*2 + 0) + (separation z i j 1 * at_ v (i.*2 + 1)
    + (- separation z i j 0 * at_ v (j.*2 + 0) + (- separation z i j 1 * at_ v (j.*2 + 1) + 0))))
  = separation (at_ (p - q)) i j 0 * separation (at_ v) i j 0 + separation (at_ (p - q)) i j 1 * separation (at_ v) i j 1.
  rewrite /separation !at_sub -/u -/z.
  by move: (u _) (u _) (u _) (u _) (z _) (z _) (z _) (z _) (at_ v _) (at_ v _) (at_ v _) (at_ v _) => *; ring.
have -> : 8%:R * norm (p - q) * norm v
   = 2%:R * norm (p - q) * (2%:R * norm v) + 2%:R * norm (p - q) * (2%:R * norm v) by ring.
by apply: le_trans (ler_norm_add _ _) _; rewrite !normrM ler_add // ler_pmul ?separation_norm.
Qed.

(** Rows are the gradients of the gaps at a contact: unit normals, plus and minus. No w occurs. *)
Definition normals q : 'M[F]_N :=
  \matrix_(l, m) ((\sum_(e <- gradient n 1 (at_ q) (contact_at l) | e.1 == m) e.2) / scale 1 radius (contact_at l)).

Hypothesis scales : forall l, scale 1 radius (contact_at l) != 0.

Lemma derivative_scales q : w != 0 -> derivative q = diag_mx (\row_l scale w radius (contact_at l)) *m normals q.
Proof.
move=> w0; apply/matrixP=> l m; rewrite mul_diag_mx !mxE; have := scales l.
case: (contact_at l) => [i j|i a|i a|k] /= D0; first by rewrite mulrC divfK.
1,3: by rewrite divr1 !(big_mkcond (fun e => e.1 == _)) /= !big_cons !big_nil; case: eqP; rewrite ?addr0 ?mulr1 ?mulr0.
rewrite divr1 !(big_mkcond (fun e => e.1 == _)) /= !big_cons !big_nil.
by case: eqP; case: eqP; rewrite /= ?addr0 ?add0r ?mulrN ?mulrBr ?mulr1 ?mulr0.
Qed.

Lemma normals_are_regular q : w != 0 -> derivative q \in unitmx -> normals q \in unitmx.
Proof. by move=> w0; rewrite derivative_scales // unitmx_mul => /andP[]. Qed.

Lemma gaps_vanish q : w != 0 -> gaps q = 0 <-> forall l : 'I_N, touch n radius place (at_ q) (contact_at l).
Proof.
move=> w0; split=> [zero l|closed].
  apply/(touch_closes _ _ _ _ _ w0)/eqP; have /colP/(_ l)/eqP := zero; rewrite !mxE mulf_eq0 invr_eq0 pnatr_eq0 //.
by apply/colP=> l; rewrite !mxE (iffLR (touch_closes _ _ _ _ _ w0) (closed l)) mulr0.
Qed.
End Box.

Print Assumptions gaps_at_the_middle.
Print Assumptions derivative_is_lipschitz.
