(** A packing in a box or a periodic cell: gaps of contacts as polynomials of the coordinates, and their derivative.

    Coordinates x_0 y_0 x_1 y_1 ... Lx Ly T. Along a periodic axis a length is a period: images of a disk are at
    (x + k Lx + l T, y + l Ly), T the tilt; a box is a cell without images. The doubled gap of a disk and an image is
    |x_i - x_j - k Lx - l T|^2 + .. - (R_i + R_j)^2, that of a disk and a wall is 2 w times their distance, w > 0 a length. Both vanish
    exactly where the grains touch, and no root is needed. A coordinate that does not move is held at its place by a row of its own. The definitions are over any ring: integers are computed
    with, and the statements speak of an ordered field. *)
From Coq Require Import ZArith.
From mathcomp Require Import all_ssreflect all_algebra ring.
From mathcomp Require Import ssrZ.
From Isostat Require Import shifted_factor max_norm contact_certificate.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** Sums of coordinates with integer factors. *)
Section Sums.
Variable R : comRingType.
Implicit Types (x y : nat -> R) (s : seq (nat * int)).
Definition sum_at x s : R := foldr (fun e sum => x e.1 *~ e.2 + sum) 0 s.

Lemma sum_at_combines x y z (a b : R) s : (forall k, z k = a * x k + b * y k) -> sum_at z s = a * sum_at x s + b * sum_at y s.
Proof.
move=> zE; elim: s => [|e s IH] /=; first by rewrite !mulr0 addr0.
by rewrite IH zE mulrzDr !mulrDr !mulrzAr addrACA.
Qed.
Lemma sum_at_scale x z (a : R) s : (forall k, z k = a * x k) -> sum_at z s = a * sum_at x s.
Proof. by move=> zE; rewrite (@sum_at_combines x x z a 0) ?mul0r ?addr0 // => k; rewrite zE mul0r addr0. Qed.
Lemma sum_at_ext x y s : {in unzip1 s, x =1 y} -> sum_at x s = sum_at y s.
Proof.
elim: s => //= e s IH same; rewrite same ?inE ?eqxx // IH // => k ks.
by rewrite same // inE ks orbT.
Qed.
Lemma sum_at_cat x s t : sum_at x (s ++ t) = sum_at x s + sum_at x t.
Proof. by elim: s => [|e s IH] /=; rewrite ?add0r // IH addrA. Qed.
Lemma sum_at_dot (a : R) x s : \sum_(e <- [seq (e.1, a *~ e.2) | e <- s]) e.2 * x e.1 = a * sum_at x s.
Proof.
elim: s => [|e s IH] /=; first by rewrite big_nil mulr0.
by rewrite big_cons IH /= mulrDr mulrzAl mulrzAr.
Qed.
End Sums.
Lemma sum_at_morphism (R S : comRingType) (phi : {rmorphism R -> S}) x s : sum_at (phi \o x) s = phi (sum_at x s).
Proof. by elim: s => [|e s IH] /=; rewrite ?rmorph0 // IH rmorphD /= rmorphMz. Qed.

(** The most by which a sum changes when no coordinate changes by more than 1. *)
Definition spread (s : seq (nat * int)) : nat := foldr (fun e sum => `|e.2| + sum)%N 0%N s.
Lemma sum_at_bound (F : realFieldType) (x : nat -> F) b s : (forall k, `|x k| <= b) -> `|sum_at x s| <= (spread s)%:R * b.
Proof.
move=> small; elim: s => [|e s IH] /=; first by rewrite normr0 mul0r.
apply: le_trans (ler_norm_add _ _) _; rewrite natrD mulrDl; apply: ler_add IH.
by rewrite -mulrzr normrM mulrC -intr_norm ler_wpmul2l ?ler0z.
Qed.

(** What the separation of disk i from an image of disk j is the sum of, along axis a. That of an own image depends on
    the periods alone. *)
Definition along (n i j : nat) (k l : Z) (a : nat) : seq (nat * int) :=
  let periods := if a is 0%N then [:: (n.*2, - int_of_Z k); (n.*2.+2, - int_of_Z l)] else [:: (n.*2.+1, - int_of_Z l)] in
  (if i == j then [::] else [:: ((i.*2 + a)%N, 1); ((j.*2 + a)%N, -1)]) ++ [seq e <- periods | e.2 != 0].

(** A row of the packing: two grains that exist, or a coordinate that is held. [walls]: the two lower walls, the two
    upper ones. [periodic]: the axes. *)
Definition in_the_packing (n : nat) (walls periodic : seq bool) (c : contact) : bool :=
  match c with
  | Image i j k l => [&& i < n, j < n, [|| i != j, k != Z0 | l != Z0], (k == Z0) || nth false periodic 0
      & (l == Z0) || nth false periodic 1]
  | Lower i a => [&& i < n, a < 2 & nth false walls a]
  | Upper i a => [&& i < n, a < 2 & nth false walls (2 + a)]
  | Held k => k < n.*2.+3
  end%N.

(** Coordinates that a row depends on, by name, whatever the entries. *)
Definition coordinates (n : nat) (c : contact) : seq nat :=
  match c with
  | Image i j k l => unzip1 (along n i j k l 0) ++ unzip1 (along n i j k l 1)
  | Lower i a => [:: i.*2 + a]
  | Upper i a => [:: n.*2 + a; i.*2 + a]
  | Held k => [:: k]
  end%N.

(** How much the entries of a gradient change when no coordinate changes by more than 1. *)
Definition entry_changes (n : nat) (c : contact) : seq (nat * nat) :=
  match c with
  | Image i j k l => flatten [seq [seq (e.1, `|e.2| * spread (along n i j k l a))%N | e <- along n i j k l a] | a <- [:: 0; 1]%N]
  | _ => [::]
  end.

(** K1 (b): C, 8 where no disk touches an image. *)
Definition curvature_of (n : nat) (c : contact) : nat :=
  if c is Image i j k l then (spread (along n i j k l 0) ^ 2 + spread (along n i j k l 1) ^ 2)%N else 0%N.
Definition curvature (n : nat) (contacts : seq contact) : nat := foldr (fun c m => maxn (curvature_of n c) m) 1%N contacts.

Section Polynomials.
Variables (R : comRingType) (n : nat) (w : R) (radius place x : nat -> R).

Definition separation (i j : nat) (k l : Z) (a : nat) : R := sum_at x (along n i j k l a).

Definition doubled_gap (c : contact) : R :=
  match c with
  | Image i j k l => separation i j k l 0 * separation i j k l 0 + separation i j k l 1 * separation i j k l 1
      - (radius i + radius j) * (radius i + radius j)
  | Lower i a => (w + w) * (x (i.*2 + a)%N - radius i)
  | Upper i a => (w + w) * (x (n.*2 + a)%N - x (i.*2 + a)%N - radius i)
  | Held k => (w + w) * (x k - place k)
  end.

(** Half the derivative of the doubled gap: coordinates that the contact depends on, with the entries. *)
Definition gradient (c : contact) : seq (nat * R) :=
  match c with
  | Image i j k l => let entries a := let s := separation i j k l a in [seq (e.1, s *~ e.2) | e <- along n i j k l a] in
      entries 0%N ++ entries 1%N
  | Lower i a => [:: ((i.*2 + a)%N, w)]
  | Upper i a => [:: ((n.*2 + a)%N, w); ((i.*2 + a)%N, - w)]
  | Held k => [:: (k, w)]
  end.

(** The length that the gradient of the gap is a multiple of: at a contact gradient / scale is the unit normal. *)
Definition scale (c : contact) : R := if c is Image i j _ _ then radius i + radius j else w.

Lemma gradient_coordinates c : unzip1 (gradient c) = coordinates n c.
Proof. by case: c => // i j k l; rewrite /gradient /coordinates /unzip1 map_cat -!map_comp. Qed.

(** Where an image of disk j is. *)
Definition image_at (j : nat) (k l : Z) (a : nat) : R :=
  if a is 0%N then x j.*2 + x n.*2 *~ int_of_Z k + x n.*2.+2 *~ int_of_Z l else x (j.*2 + 1)%N + x n.*2.+1 *~ int_of_Z l.

Lemma separation_is_from_the_image i j k l a : (a < 2)%N -> separation i j k l a = x (i.*2 + a)%N - image_at j k l a.
Proof.
have dropped s : sum_at x [seq e <- s | e.2 != 0] = sum_at x s.
  by elim: s => //= e s <-; case: ifPn => //=; rewrite negbK => /eqP ->; rewrite mulr0z add0r.
have ends b : sum_at x (if i == j then [::] else [:: ((i.*2 + b)%N, 1); ((j.*2 + b)%N, -1)]) = x (i.*2 + b)%N - x (j.*2 + b)%N.
  by case: eqP => [->|_] /=; rewrite ?subrr // mulr1z mulrNz mulr1z addr0.
case: a => [|[|a]] // _; rewrite /separation /along sum_at_cat dropped ends /= !mulrNz ?addn0 ?addr0; ring.
Qed.
End Polynomials.

Lemma doubled_gap_morphism (R S : comRingType) (phi : {rmorphism R -> S}) n w radius place x c :
  doubled_gap n (phi w) (phi \o radius) (phi \o place) (phi \o x) c = phi (doubled_gap n w radius place x c).
Proof. by case: c => *; rewrite /doubled_gap /separation ?sum_at_morphism !(rmorphB, rmorphD, rmorphM). Qed.

Lemma gradient_morphism (R S : comRingType) (phi : {rmorphism R -> S}) n w x c :
  gradient n (phi w) (phi \o x) c = [seq (e.1, phi e.2) | e <- gradient n w x c].
Proof.
case: c => [i j k l|i a|i a|k] /=; rewrite ?(rmorphN, rmorphB, rmorphD) // map_cat -!map_comp /separation !sum_at_morphism.
by congr (_ ++ _); apply: eq_map => e /=; rewrite rmorphMz.
Qed.

Lemma doubled_gap_depends (R : comRingType) n (w : R) radius place x y c : {in coordinates n c, x =1 y} ->
  doubled_gap n w radius place x c = doubled_gap n w radius place y c.
Proof.
case: c => [i j k l|i a|i a|k] /= xy; rewrite ?xy ?inE ?eqxx ?orbT //.
by rewrite /separation; do 2?[rewrite (@sum_at_ext _ x y) => [|m ms]; last by rewrite xy // mem_cat ms ?orbT].
Qed.
Lemma doubled_gap_ext (R : comRingType) n (w : R) radius place x y c : x =1 y ->
  doubled_gap n w radius place x c = doubled_gap n w radius place y c.
Proof. by move=> xy; apply: doubled_gap_depends => k _; apply: xy. Qed.

Lemma gradient_ext (R : comRingType) n (w : R) x y c : x =1 y -> gradient n w x c = gradient n w y c.
Proof.
move=> xy; case: c => //= i j k l; rewrite /separation; congr (_ ++ _); apply: eq_map => e;
  by rewrite (@sum_at_ext _ x y) // => m _; apply: xy.
Qed.

(** Grains touch, in the words of geometry: with squares, as no root is needed. *)
Definition touch (F : realFieldType) (n : nat) (radius place x : nat -> F) (c : contact) : Prop :=
  match c with
  | Image i j k l => (x (i.*2)%N - image_at n x j k l 0) ^+ 2 + (x (i.*2 + 1)%N - image_at n x j k l 1) ^+ 2
      = (radius i + radius j) ^+ 2
  | Lower i a => x (i.*2 + a)%N = radius i
  | Upper i a => x (i.*2 + a)%N + radius i = x (n.*2 + a)%N
  | Held k => x k = place k
  end.

Lemma touch_closes (F : realFieldType) n (w : F) radius place x c : w != 0 ->
  touch n radius place x c <-> doubled_gap n w radius place x c = 0.
Proof.
move=> w0; have ww : w + w != 0 by rewrite -mulr2n mulrn_eq0.
case: c => [i j k l|i a|i a|k] /=.
- rewrite !separation_is_from_the_image // addn0 -!expr2.
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
Let N := (n.*2.+3)%N.
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
Lemma sum_at_sub p q s : sum_at (at_ (p - q)) s = sum_at (at_ p) s - sum_at (at_ q) s.
Proof. by rewrite (@sum_at_combines _ (at_ p) (at_ q) _ 1 (-1)) => [|k]; rewrite ?at_sub !mul1r !mulN1r. Qed.

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
case: (contact_at l) => [i j k m|i a|i a|k] /=.
- rewrite big_cat /= !sum_at_dot /separation !sum_at_sub.
  have middle s : sum_at (at_ (2%:R^-1 *: (p + q))) s = 2%:R^-1 * sum_at (at_ p) s + 2%:R^-1 * sum_at (at_ q) s.
    by apply: sum_at_combines => b; rewrite at_scale at_add mulrDr.
  by rewrite !middle; move: (sum_at _ _) (sum_at _ _) (sum_at _ _) (sum_at _ _) => *; field.
- by rewrite !big_cons big_nil /= !(at_sub, at_scale, at_add); move: (at_ p _) (at_ q _) => *; field.
- by rewrite !big_cons big_nil /= !(at_sub, at_scale, at_add); move: (at_ p _) (at_ p _) (at_ q _) (at_ q _) => *; field.
- by rewrite !big_cons big_nil /= !(at_sub, at_scale, at_add); move: (at_ p _) (at_ q _) => *; field.
Qed.

Lemma curvature_is_largest l : (curvature_of n (contact_at l) <= curvature n contacts)%N.
Proof.
rewrite /contact_at /curvature; elim: contacts l => [|c cs IH] [|l] //=; first exact: leq_maxl.
by rewrite leq_max IH orbT.
Qed.
Lemma curvature_is_positive : (0 < curvature n contacts)%N.
Proof. by elim: contacts => //= c cs IH; rewrite leq_max IH orbT. Qed.

(** K1 (b): entries of the derivative are linear in the configuration. *)
Theorem derivative_is_lipschitz p q v :
  norm (derivative p *m v - derivative q *m v) <= (curvature n contacts)%:R * norm (p - q) * norm v.
Proof.
have pq0 := norm_ge0 (p - q); have v0 := norm_ge0 v.
have bound : 0 <= (curvature n contacts)%:R * norm (p - q) * norm v by rewrite !mulr_ge0 ?ler0n.
apply: norm_le => // l; rewrite mxE [X in _ + X]mxE !derivative_entry.
have := curvature_is_largest l; case: (contact_at l) => [i j k m|i a|i a|k] /= least; last 3 first.
- by rewrite !big_cons !big_nil /= subrr normr0.
- by rewrite !big_cons !big_nil /= subrr normr0.
- by rewrite !big_cons !big_nil /= subrr normr0.
rewrite !big_cat /= !sum_at_dot opprD addrACA -!mulrBl -!sum_at_sub.
apply: le_trans (ler_norm_add _ _) _; rewrite !normrM.
apply: le_trans (_ : (spread (along n i j k m 0) ^ 2 + spread (along n i j k m 1) ^ 2)%:R * (norm (p - q) * norm v) <= _).
  rewrite natrD mulrDl; apply: ler_add; rewrite natrX expr2 mulrACA.
    by rewrite ler_pmul // sum_at_bound // => b; apply: at_norm.
  by rewrite ler_pmul // sum_at_bound // => b; apply: at_norm.
by rewrite -mulrA ler_wpmul2r ?mulr_ge0 // ler_nat.
Qed.

(** Rows are the gradients of the gaps at a contact: unit normals, plus and minus. No w occurs. *)
Definition normals q : 'M[F]_N :=
  \matrix_(l, m) ((\sum_(e <- gradient n 1 (at_ q) (contact_at l) | e.1 == m) e.2) / scale 1 radius (contact_at l)).

Hypothesis scales : forall l, scale 1 radius (contact_at l) != 0.

Lemma derivative_scales q : w != 0 -> derivative q = diag_mx (\row_l scale w radius (contact_at l)) *m normals q.
Proof.
move=> w0; apply/matrixP=> l m; rewrite mul_diag_mx !mxE; have := scales l.
case: (contact_at l) => [i j k k'|i a|i a|k] /= D0; first by rewrite mulrC divfK.
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
