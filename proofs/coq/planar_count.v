(** Statement T7 (a), steps 4 to 6 (../generic_isostaticity.md): there is no sign pattern with four changes around
  each disk and two around
    each wall on the contact graph of a packing.

    The plane graph is given by its darts (an edge with a direction): [e] reverses a dart,
      [n] turns to the next dart around the vertex where
    it starts, and [face] walks along the boundary of a face. Vertices and faces are the orbits of [n] and [face];
      [froots] has one dart of
    each. That the drawing is plane and connected is Euler's formula, a hypothesis;
      everything else that the count needs is derived. *)
From mathcomp Require Import all_ssreflect zify.
Set Implicit Arguments.
Unset Strict Implicit.

Section PlanarCount.
Variables (D : finType) (e n : D -> D).
Hypothesis e_involution : involutive e.
Hypothesis n_injective : injective n.
Definition face (d : D) := n (e d).

(** A simple graph: no loops, no two edges with the same ends. *)
Hypothesis no_loop : forall d, ~~ fconnect n d (e d).
Hypothesis no_double_edge : forall d d', fconnect n d d' -> fconnect n (e d) (e d') -> d = d'.

(** Plane and connected: V + F = E + 2. *)
Hypothesis euler : (2 * (#|froots n| + #|froots face|) = #|D| + 4)%N.

(** The wall vertices: never adjacent, and each with a dart on the boundary of one face, the unbounded one. *)
Variables (wall : pred D) (outer : D).
Hypothesis wall_vertex : forall d, wall (n d) = wall d.
Hypothesis walls_apart : forall d, wall d -> ~~ wall (e d).
Hypothesis walls_outside : forall d, wall d -> exists2 d', fconnect n d d' & fconnect face outer d'.

(** Signs of the contacts. *)
Variable s : D -> bool.
Hypothesis sign_of_edge : forall d, s (e d) = s d.
Definition changes (g : D -> D) (r : D) : nat := \sum_(d | fconnect g r d) (s d != s (g d)).
Hypothesis changes_at_disks : forall d, ~~ wall d -> 4 <= changes n d.
Hypothesis changes_at_walls : forall d, wall d -> 2 <= changes n d.

Let e_injective : injective e := inv_inj e_involution.
Let f_injective : injective face. Proof. by move=> d d' /n_injective/e_injective. Qed.

Lemma sum_by_orbit (g : D -> D) (F : D -> nat) : injective g ->
  \sum_d F d = \sum_(r in froots g) \sum_(d | fconnect g r d) F d.
Proof.
move=> gi; have sym := fconnect_sym gi.
rewrite (partition_big (froot g) (mem (froots g))) /=; last by move=> d _; apply: roots_root.
apply: eq_bigr => r /eqP rr; apply: eq_bigl => d.
by rewrite sym -(root_connect sym) /= rr.
Qed.

Lemma changes_are_even (g : D -> D) (r : D) : injective g -> ~~ odd (changes g r).
Proof.
move=> gi; rewrite /changes (big_morph odd oddD (erefl : odd 0 = false)).
have -> : \big[addb/false]_(d | fconnect g r d) odd (s d != s (g d)) = \big[addb/false]_(d | fconnect g r d) (s d (+)
  s (g d)).
  by apply: eq_bigr => d _; case: (s d); case: (s (g d)).
rewrite big_split /= [X in X (+) _](reindex_inj gi) /=.
have -> : \big[addb/false]_(d | fconnect g r (g d)) s (g d) = \big[addb/false]_(d | fconnect g r d) s (g d).
  by apply: eq_bigl => d; rewrite -same_fconnect1_r.
by rewrite addbb.
Qed.

Lemma changes_at_most_degree (g : D -> D) (r : D) : changes g r <= order g r.
Proof. by rewrite /changes /order -sum1_card; apply: leq_sum => d _; case: (_ != _). Qed.

(** A walk of length 3 has at most two changes, a longer one at most its length. *)
Lemma changes_of_a_closed_walk (c d : nat) : ~~ odd c -> c <= d -> 3 <= d -> c + 4 <= 2 * d.
Proof. by rewrite -dvdn2 => /dvdnP[k ->]; lia. Qed.

(** Each corner belongs to one vertex and to one face. *)
Lemma corners_of_vertices_and_faces : \sum_d (s d != s (n d) : nat) = \sum_d (s d != s (face d) : nat).
Proof. by rewrite (reindex_inj e_injective) /=; apply: eq_bigr => d _; rewrite sign_of_edge. Qed.

Lemma faces_have_three_sides (d : D) : 3 <= order face d.
Proof.
have sym := fconnect_sym n_injective.
have cycle := iter_order f_injective d.
rewrite leqNgt; apply/negP => small; case E : (order face d) small cycle => [|[|[|k]]] // _ /= cycle.
- by move: (order_gt0 face d); rewrite E.
- by have := no_loop d; rewrite -{1}cycle /face -same_fconnect1 // connect0.
have back : d = e (face d).
  apply: no_double_edge; last by rewrite e_involution /face fconnect1.
  by rewrite sym -{2}cycle {1}/face fconnect1.
have loop : n (e d) = e d by rewrite {2}back e_involution.
have none : changes n (e d) = 0.
  have only x : fconnect n (e d) x -> x = e d by move=> /iter_findex <-; elim: (findex _ _ _) => //= m ->.
  by rewrite /changes big1 // => x /only ->; rewrite loop eqxx.
have := changes_at_walls (d := e d); have := changes_at_disks (d := e d); rewrite none.
by case: (wall _) => /= [_ /(_ isT)|/(_ isT)].
Qed.

Lemma unbounded_face_passes_all_walls : 2 * #|[pred r in froots n | wall r]| <= order face outer.
Proof.
have sym := fconnect_sym n_injective.
pose T := [pred d | fconnect face outer d && wall d].
have wall_orbit d d' : fconnect n d d' -> wall d' = wall d by move=> /iter_findex <-; elim: (findex _ _ _) => //= m;
  rewrite wall_vertex.
have few : #|[pred r in froots n | wall r]| <= #|T|.
  apply: leq_trans (leq_image_card (froot n) T); apply: subset_leq_card; apply/subsetP => r /andP[/eqP rr wr].
  have [d nd fd] := walls_outside wr; apply/imageP; exists d; last by rewrite -rr; apply/eqP;
    rewrite (root_connect sym).
  by rewrite inE fd /= (wall_orbit r d).
have next d : d \in T -> face d \notin T.
  by rewrite !inE => /andP[_ wd]; rewrite negb_and /face wall_vertex (negPf (walls_apart wd)) orbT.
have disjoint : [disjoint T & [pred d in image face T]].
  by apply/pred0P => d /=; apply/negbTE/negP => /andP[dT /imageP[d' d'T E]]; move: (next d' d'T); rewrite -E dT.
have : #|[predU T & [pred d in image face T]]| <= order face outer.
  apply: subset_leq_card; apply/subsetP => d; rewrite !inE => /orP[/andP[]//|/imageP[d' /andP[od' _] ->]].
  by rewrite -same_fconnect1_r.
have := cardUI T [pred d in image face T]; rewrite (eqP (_ : #|[predI T & [pred d in image face T]]| == 0)); last first.
  by rewrite -/(pred0b _); apply: disjoint.
have -> : #|[pred d in image face T]| = #|T| by rewrite -(card_image f_injective T); apply: eq_card => d; rewrite inE.
by rewrite addn0 => -> sum; apply: leq_trans sum; rewrite addnn -mul2n leq_mul2l few.
Qed.

Theorem no_such_sign_pattern : False.
Proof.
pose V := #|froots n|; pose W := #|[pred r in froots n | wall r]|; pose F := #|froots face|;
  pose C := \sum_d (s d != s (n d) : nat).
have vertices : 4 * V <= C + 2 * W.
  rewrite /C (sum_by_orbit _ n_injective) /V /W -!sum1_card !big_distrr /= [X in _ + X]big_mkcondr -big_split /=.
  apply: leq_sum => r _; case E : (wall r) => /=.
    by rewrite muln1 addn2 ltnS -/(changes n r); have := changes_at_walls E; lia.
  by rewrite addn0; apply: changes_at_disks; rewrite E.
have faces : C + 4 * F + order face outer <= 2 * #|D| + 4.
  rewrite /C corners_of_vertices_and_faces (sum_by_orbit _ f_injective) /F -sum1_card big_distrr /= -big_split /=.
  have -> : #|D| = \sum_(r in froots face) order face r.
    rewrite -sum1_card (eq_bigl xpredT) // (sum_by_orbit _ f_injective).
    by apply: eq_bigr => r _; rewrite sum1_card.
  have sym := fconnect_sym f_injective.
  set r0 := froot face outer; have r0in : r0 \in froots face by apply: roots_root.
  have same : order face outer = order face r0.
    by apply: eq_card => d; apply: same_connect => //; apply: connect_root.
  rewrite same big_distrr /= (bigD1 r0 r0in) /= [X in _ <= X + _](bigD1 r0 r0in) /=.
  have others : \sum_(r in froots face | r != r0) (changes face r + 4 * 1) <= \sum_(r in froots face | r != r0) 2 *
    order face r.
    apply: leq_sum => r _; rewrite muln1.
    exact: changes_of_a_closed_walk (changes_are_even r f_injective) (changes_at_most_degree face r)
      (faces_have_three_sides r).
  have sum (c o x y : nat) : c <= o -> x <= y -> c + 4 * 1 + x + o <= 2 * o + y + 4 by lia.
  exact: sum (changes_at_most_degree face r0) others.
have := unbounded_face_passes_all_walls; rewrite -/W; move: euler vertices faces; rewrite -/V -/F; lia.
Qed.
End PlanarCount.

Print Assumptions no_such_sign_pattern.
