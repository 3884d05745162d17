(** A packing in a box or a periodic cell: gaps of contacts as polynomials of the coordinates, and their derivative.

    One theory for disks of the plane, d = 2, and spheres of space, d = 3. Coordinates: those of grain i from d i on, the d
    lengths from d n on, then the d (d - 1) / 2 tilts xy, xz, yz. Along a periodic axis a length is a period: images of a
    grain are at (x + k Lx + l Txy + m Txz, y + l Ly + m Tyz, z + m Lz); a box is a cell without images. The doubled gap of
    a grain and an image is |x_i - x_j - k Lx - ..|^2 + .. - (R_i + R_j)^2, that of a grain and a wall is 2 w times their
    distance, w > 0 a length. Both vanish exactly where the grains touch, and no root is needed. A coordinate that does not
    move is held at its place by a row of its own. The definitions are over any ring: integers are computed with, and the
    statements speak of an ordered field. *)
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

(** The number of coordinates: 2 n + 3 in the plane, 3 n + 6 in space. *)
Notation coordinates_of d n := ((n * axes d + if d is Plane then 2 else 5).+1).

(** Sums over the axes. *)
Definition over (R : zmodType) (d : dimension) (f : nat -> R) : R := foldr (fun a sum => f a + sum) 0 (iota 0 d).
Lemma overE (R : zmodType) (d : dimension) (f : nat -> R) : over d f = \sum_(a < d) f a.
Proof. by case: d; rewrite /over /= !big_ord_recl big_ord0. Qed.
Lemma over_ext (R : zmodType) (d : dimension) (f g : nat -> R) : (forall a, (a < d)%N -> f a = g a) -> over d f = over d g.
Proof. by move=> fg; rewrite !overE; apply: eq_bigr => a _; apply: fg. Qed.
Lemma big_axes (R : zmodType) (T : Type) (d : dimension) (s : nat -> seq T) (P : pred T) (f : T -> R) :
  \sum_(e <- flatten [seq s a | a <- iota 0 d] | P e) f e = over d (fun a => \sum_(e <- s a | P e) f e).
Proof. by rewrite big_flatten big_map /over; elim: (iota 0 d) => [|a l IH]; rewrite ?big_nil // big_cons IH. Qed.

(** What the separation of grain i from an image of grain j is the sum of, along axis a. That of an own image depends on
    the periods alone. *)
Definition along (d : dimension) (n i j : nat) (k l m : Z) (a : nat) : seq (nat * int) :=
  let periods := match a with
    | 0%N => [:: (0%N, k); (d : nat, l); (d.+1, m)]
    | 1%N => [:: (1%N, l); (d.+2, m)]
    | _ => [:: (2%N, m)]
    end in
  (if i == j then [::] else [:: ((i * d + a)%N, 1); ((j * d + a)%N, -1)])
    ++ [seq ((n * d + e.1)%N, - int_of_Z e.2) | e <- periods & e.2 != 0].

Definition repeats (d : dimension) (periodic : seq bool) (a : nat) : bool := (a < d)%N && nth false periodic a.

(** A row of the packing: two grains that exist, or a coordinate that is held. [walls]: the lower walls, then the upper
    ones. [periodic]: the axes. *)
Definition in_the_packing (d : dimension) (n : nat) (walls periodic : seq bool) (c : contact) : bool :=
  match c with
  | Image i j k l m => [&& i < n, j < n, [|| i != j, k != Z0, l != Z0 | m != Z0], (k == Z0) || repeats d periodic 0
      & ((l == Z0) || repeats d periodic 1) && ((m == Z0) || repeats d periodic 2)]
  | Lower i a => [&& i < n, a < d & nth false walls a]
  | Upper i a => [&& i < n, a < d & nth false walls (d + a)]
  | Held k => k < coordinates_of d n
  end%N.

(** Coordinates that a row depends on, by name, whatever the entries. *)
Definition coordinates (d : dimension) (n : nat) (c : contact) : seq nat :=
  match c with
  | Image i j k l m => flatten [seq unzip1 (along d n i j k l m a) | a <- iota 0 d]
  | Lower i a => [:: i * d + a]
  | Upper i a => [:: n * d + a; i * d + a]
  | Held k => [:: k]
  end%N.

(** How much the entries of a gradient change when no coordinate changes by more than 1. *)
Definition entry_changes (d : dimension) (n : nat) (c : contact) : seq (nat * nat) :=
  match c with
  | Image i j k l m =>
      flatten [seq let s := along d n i j k l m a in let t := spread s in [seq (e.1, `|e.2| * t)%N | e <- s] | a <- iota 0 d]
  | _ => [::]
  end.

(** K1 (b): C, where no grain touches an image 8 in the plane and 12 in space. *)
Definition curvature_of (d : dimension) (n : nat) (c : contact) : nat :=
  if c is Image i j k l m then sumn [seq spread (along d n i j k l m a) ^ 2 | a <- iota 0 d]%N else 0%N.
Definition curvature (d : dimension) (n : nat) (contacts : seq contact) : nat :=
  foldr (fun c m => maxn (curvature_of d n c) m) 1%N contacts.

Section Polynomials.
Variables (R : comRingType) (d : dimension) (n : nat) (w : R) (radius place x : nat -> R).

Definition separation (i j : nat) (k l m : Z) (a : nat) : R := sum_at x (along d n i j k l m a).

Definition doubled_gap (c : contact) : R :=
  match c with
  | Image i j k l m => over d (fun a => let s := separation i j k l m a in s * s)
      - (radius i + radius j) * (radius i + radius j)
  | Lower i a => (w + w) * (x (i * d + a)%N - radius i)
  | Upper i a => (w + w) * (x (n * d + a)%N - x (i * d + a)%N - radius i)
  | Held k => (w + w) * (x k - place k)
  end.

(** Half the derivative of the doubled gap: coordinates that the contact depends on, with the entries. *)
Definition gradient (c : contact) : seq (nat * R) :=
  match c with
  | Image i j k l m => flatten [seq let s := along d n i j k l m a in let u := sum_at x s in [seq (e.1, u *~ e.2) | e <- s] | a <- iota 0 d]
  | Lower i a => [:: ((i * d + a)%N, w)]
  | Upper i a => [:: ((n * d + a)%N, w); ((i * d + a)%N, - w)]
  | Held k => [:: (k, w)]
  end.

(** The length that the gradient of the gap is a multiple of: at a contact gradient / scale is the unit normal. *)
Definition scale (c : contact) : R := if c is Image i j _ _ _ then radius i + radius j else w.

Lemma gradient_coordinates c : unzip1 (gradient c) = coordinates d n c.
Proof.
case: c => // i j k l m; rewrite /gradient /coordinates /unzip1 map_flatten -map_comp.
by congr flatten; apply: eq_map => a /=; rewrite -map_comp.
Qed.

(** Where an image of grain j is. *)
Definition image_at (j : nat) (k l m : Z) (a : nat) : R :=
  x (j * d + a)%N + let cell b := x (n * d + b)%N in
  match a with
  | 0%N => cell 0%N *~ int_of_Z k + cell d *~ int_of_Z l + cell d.+1 *~ int_of_Z m
  | 1%N => cell 1%N *~ int_of_Z l + cell d.+2 *~ int_of_Z m
  | _ => cell 2%N *~ int_of_Z m
  end.

Lemma separation_is_from_the_image i j k l m a : separation i j k l m a = x (i * d + a)%N - image_at j k l m a.
Proof.
have dropped s : sum_at x [seq ((n * d + e.1)%N, - int_of_Z e.2) | e <- s & e.2 != 0]
    = - foldr (fun e sum => x (n * d + e.1)%N *~ int_of_Z e.2 + sum) 0 s.
  elim: s => [|e s IH] /=; first by rewrite oppr0.
  case: ifPn => [_|]; first by rewrite /= IH mulrNz opprD.
  by rewrite negbK => /eqP ->; rewrite IH rmorph0 mulr0z add0r.
have ends b : sum_at x (if i == j then [::] else [:: ((i * d + b)%N, 1); ((j * d + b)%N, -1)]) = x (i * d + b)%N - x (j * d + b)%N.
  by case: eqP => [->|_] /=; rewrite ?subrr // mulr1z mulrNz mulr1z addr0.
by rewrite /separation /along sum_at_cat dropped ends /image_at; case: a => [|[|a]] /=; ring.
Qed.
End Polynomials.

Lemma over_morphism (R S : ringType) (phi : {rmorphism R -> S}) d (f : nat -> R) : over d (phi \o f) = phi (over d f).
Proof. by rewrite !overE rmorph_sum. Qed.

Lemma doubled_gap_morphism (R S : comRingType) (phi : {rmorphism R -> S}) d n w radius place x c :
  doubled_gap d n (phi w) (phi \o radius) (phi \o place) (phi \o x) c = phi (doubled_gap d n w radius place x c).
Proof.
case: c => [i j k l m|i a|i a|k]; rewrite /doubled_gap !(rmorphB, rmorphD, rmorphM) //= -over_morphism; congr (_ - _).
by apply: over_ext => a _ /=; rewrite /separation !sum_at_morphism rmorphM.
Qed.

Lemma gradient_morphism (R S : comRingType) (phi : {rmorphism R -> S}) d n w x c :
  gradient d n (phi w) (phi \o x) c = [seq (e.1, phi e.2) | e <- gradient d n w x c].
Proof.
case: c => [i j k l m|i a|i a|k]; rewrite /gradient /= ?rmorphN // map_flatten -map_comp; congr flatten.
by apply: eq_map => a /=; rewrite -map_comp /separation sum_at_morphism; apply: eq_map => e /=; rewrite rmorphMz.
Qed.

Lemma along_coordinates d n i j k l m a b : (a < axes d)%N -> b \in unzip1 (along d n i j k l m a) ->
  b \in coordinates d n (Image i j k l m).
Proof. by move=> ad inside; apply/flatten_mapP; exists a => //; rewrite mem_iota. Qed.

Lemma doubled_gap_depends (R : comRingType) d n (w : R) radius place x y c : {in coordinates d n c, x =1 y} ->
  doubled_gap d n w radius place x c = doubled_gap d n w radius place y c.
Proof.
case: c => [i j k l m|i a|i a|k] xy; rewrite /doubled_gap ?xy ?inE ?eqxx ?orbT //; congr (_ - _).
by apply: over_ext => a ad; rewrite /separation (@sum_at_ext _ x y) // => b /(along_coordinates ad)/xy.
Qed.
Lemma doubled_gap_ext (R : comRingType) d n (w : R) radius place x y c : x =1 y ->
  doubled_gap d n w radius place x c = doubled_gap d n w radius place y c.
Proof. by move=> xy; apply: doubled_gap_depends => k _; apply: xy. Qed.

Lemma gradient_ext (R : comRingType) d n (w : R) x y c : x =1 y -> gradient d n w x c = gradient d n w y c.
Proof.
move=> xy; case: c => //= i j k l m; congr flatten; apply: eq_map => a; rewrite /separation.
by rewrite (@sum_at_ext _ x y) // => b _; apply: xy.
Qed.

(** Grains touch, in the words of geometry: with squares, as no root is needed. *)
Definition distance2 (R : comRingType) (d : dimension) (n : nat) (x : nat -> R) (i j : nat) (k l m : Z) : R :=
  \sum_(a < d) (x (i * d + a)%N - image_at d n x j k l m a) ^+ 2.
Definition touch (F : realFieldType) (d : dimension) (n : nat) (radius place x : nat -> F) (c : contact) : Prop :=
  match c with
  | Image i j k l m => distance2 d n x i j k l m = (radius i + radius j) ^+ 2
  | Lower i a => x (i * d + a)%N = radius i
  | Upper i a => x (i * d + a)%N + radius i = x (n * d + a)%N
  | Held k => x k = place k
  end.

Lemma distance_by_separations (R : comRingType) d n (x : nat -> R) i j k l m :
  distance2 d n x i j k l m = over d (fun a => separation d n x i j k l m a * separation d n x i j k l m a).
Proof. by rewrite overE; apply: eq_bigr => a _; rewrite separation_is_from_the_image expr2. Qed.

Lemma touch_closes (F : realFieldType) d n (w : F) radius place x c : w != 0 ->
  touch d n radius place x c <-> doubled_gap d n w radius place x c = 0.
Proof.
move=> w0; have ww : w + w != 0 by rewrite -mulr2n mulrn_eq0.
case: c => [i j k l m|i a|i a|k] /=.
- by rewrite distance_by_separations -expr2; split=> [->|/eqP]; [rewrite subrr|rewrite subr_eq0 => /eqP].
- split=> [->|/eqP]; first by rewrite subrr mulr0.
  by rewrite mulf_eq0 (negPf ww) subr_eq0 => /eqP.
- split=> [<-|/eqP]; first by rewrite [_ + radius i]addrC addrK subrr mulr0.
  by rewrite mulf_eq0 (negPf ww) -addrA -opprD subr_eq0 => /eqP.
- split=> [->|/eqP]; first by rewrite subrr mulr0.
  by rewrite mulf_eq0 (negPf ww) subr_eq0 => /eqP.
Qed.

Section Box.
Variables (F : realFieldType) (d : dimension) (n : nat) (w : F) (radius place : nat -> F) (contacts : seq contact).
Let N := (coordinates_of d n)%N.
Implicit Types (p q v : 'cV[F]_N).

(** Coordinate k of a configuration; 0 when there is none. *)
Definition at_ q (k : nat) : F := \sum_(m < N | m == k :> nat) q m 0.
Definition contact_at (l : nat) : contact := nth (Lower 0 0) contacts l.
Definition gaps q : 'cV[F]_N := \col_l (2%:R^-1 * doubled_gap d n w radius place (at_ q) (contact_at l)).
Definition derivative q : 'M[F]_N := \matrix_(l, m) \sum_(e <- gradient d n w (at_ q) (contact_at l) | e.1 == m) e.2.

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
  (derivative q *m v) l 0 = \sum_(e <- gradient d n w (at_ q) (contact_at l)) e.2 * at_ v e.1.
Proof.
rewrite mxE; under eq_bigr => m _ do rewrite mxE mulr_suml.
rewrite (exchange_big_dep xpredT) //=; apply: eq_bigr => e _; rewrite /at_ mulr_sumr.
by apply: eq_bigl => m; rewrite eq_sym.
Qed.

Lemma gradient_dot (x y : nat -> F) i j k l m : \sum_(e <- gradient d n w x (Image i j k l m)) e.2 * y e.1
  = over d (fun a => separation d n x i j k l m a * sum_at y (along d n i j k l m a)).
Proof. by rewrite big_axes; apply: over_ext => a _; rewrite sum_at_dot. Qed.

Theorem gaps_at_the_middle p q : gaps p - gaps q = derivative (2%:R^-1 *: (p + q)) *m (p - q).
Proof.
have two : 2%:R != 0 :> F by rewrite pnatr_eq0.
apply/colP=> l; rewrite derivative_entry !mxE.
case: (contact_at l) => [i j k k' m|i a|i a|k].
- rewrite gradient_dot.
  have middle s : sum_at (at_ (2%:R^-1 *: (p + q))) s = 2%:R^-1 * sum_at (at_ p) s + 2%:R^-1 * sum_at (at_ q) s.
    by apply: sum_at_combines => b; rewrite at_scale at_add mulrDr.
  rewrite -mulrBr opprB addrA subrK !overE -sumrB mulr_sumr; apply: eq_bigr => a _.
  by rewrite /separation middle sum_at_sub; move: (sum_at _ _) (sum_at _ _) => *; field.
- by rewrite !big_cons big_nil /= !(at_sub, at_scale, at_add); move: (at_ p _) (at_ q _) => *; field.
- by rewrite !big_cons big_nil /= !(at_sub, at_scale, at_add); move: (at_ p _) (at_ p _) (at_ q _) (at_ q _) => *; field.
- by rewrite !big_cons big_nil /= !(at_sub, at_scale, at_add); move: (at_ p _) (at_ q _) => *; field.
Qed.

Lemma curvature_is_largest l : (curvature_of d n (contact_at l) <= curvature d n contacts)%N.
Proof.
rewrite /contact_at /curvature; elim: contacts l => [|c cs IH] [|l] //=; first exact: leq_maxl.
by rewrite leq_max IH orbT.
Qed.
Lemma curvature_is_positive : (0 < curvature d n contacts)%N.
Proof. by elim: contacts => //= c cs IH; rewrite leq_max IH orbT. Qed.

(** K1 (b): entries of the derivative are linear in the configuration. *)
Theorem derivative_is_lipschitz p q v :
  norm (derivative p *m v - derivative q *m v) <= (curvature d n contacts)%:R * norm (p - q) * norm v.
Proof.
have pq0 := norm_ge0 (p - q); have v0 := norm_ge0 v.
have bound : 0 <= (curvature d n contacts)%:R * norm (p - q) * norm v by rewrite !mulr_ge0 ?ler0n.
apply: norm_le => // l; rewrite mxE [X in _ + X]mxE !derivative_entry.
have := curvature_is_largest l; case: (contact_at l) => [i j k k' m|i a|i a|k] least; last 3 first.
- by rewrite /= !big_cons !big_nil /= subrr normr0.
- by rewrite /= !big_cons !big_nil /= subrr normr0.
- by rewrite /= !big_cons !big_nil /= subrr normr0.
rewrite !gradient_dot !overE -sumrB; apply: le_trans (ler_norm_sum _ _ _) _.
apply: le_trans (_ : (curvature_of d n (Image i j k k' m))%:R * (norm (p - q) * norm v) <= _); last first.
  by rewrite -mulrA ler_wpmul2r ?mulr_ge0 // ler_nat.
have -> : (curvature_of d n (Image i j k k' m))%:R = over d (fun a => (spread (along d n i j k k' m a))%:R ^+ 2) :> F.
  by rewrite /over /curvature_of; elim: (iota 0 d) => //= a s <-; rewrite natrD natrX.
rewrite overE mulr_suml; apply: ler_sum => a _; rewrite -mulrBl normrM -sum_at_sub expr2 mulrACA.
by apply: ler_pmul => //; apply: sum_at_bound => b; apply: at_norm.
Qed.

(** Rows are the gradients of the gaps at a contact: unit normals, plus and minus. No w occurs. *)
Definition normals q : 'M[F]_N :=
  \matrix_(l, m) ((\sum_(e <- gradient d n 1 (at_ q) (contact_at l) | e.1 == m) e.2) / scale 1 radius (contact_at l)).

Hypothesis scales : forall l, scale 1 radius (contact_at l) != 0.

Lemma derivative_scales q : w != 0 -> derivative q = diag_mx (\row_l scale w radius (contact_at l)) *m normals q.
Proof.
move=> w0; apply/matrixP=> l m; rewrite mul_diag_mx !mxE; have := scales l.
case: (contact_at l) => [i j k k' k''|i a|i a|k] /= D0; first by rewrite mulrC divfK.
1,3: by rewrite divr1 !(big_mkcond (fun e => e.1 == _)) /= !big_cons !big_nil; case: eqP; rewrite ?addr0 ?mulr1 ?mulr0.
rewrite divr1 !(big_mkcond (fun e => e.1 == _)) /= !big_cons !big_nil.
by case: eqP; case: eqP; rewrite /= ?addr0 ?add0r ?mulrN ?mulrBr ?mulr1 ?mulr0.
Qed.

Lemma normals_are_regular q : w != 0 -> derivative q \in unitmx -> normals q \in unitmx.
Proof. by move=> w0; rewrite derivative_scales // unitmx_mul => /andP[]. Qed.

Lemma gaps_vanish q : w != 0 -> gaps q = 0 <-> forall l : 'I_N, touch d n radius place (at_ q) (contact_at l).
Proof.
move=> w0; split=> [zero l|closed].
  apply/(touch_closes _ _ _ _ _ _ w0)/eqP; have /colP/(_ l)/eqP := zero; rewrite !mxE mulf_eq0 invr_eq0 pnatr_eq0 //.
by apply/colP=> l; rewrite !mxE (iffLR (touch_closes _ _ _ _ _ _ w0) (closed l)) mulr0.
Qed.
End Box.

Print Assumptions gaps_at_the_middle.
Print Assumptions derivative_is_lipschitz.
