(** Statement K10 (../checker.md) for a packing in a box or a cell: how far a load may change before a contact opens.

    The load is moved along a straight line; the forces follow along one. Up to the end of the interval contacts that
    push bear the load, beyond it none do. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
From Isostat Require Import statics shifted_factor max_norm contact_certificate box box_forces.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Load.
Variables (F : realFieldType) (d : dimension) (n : nat) (radius : nat -> F) (contacts : seq contact).
Let N := (coordinates_of d n)%N.
Variable q : 'cV[F]_N.
Let bal := balanced radius contacts q.

(** Contacts push, or bear nothing, and balance the load; what holds a coordinate may pull as well. *)
Definition borne (load : 'cV[F]_N) : Prop := exists2 f, balanced radius contacts q load f &
  forall l : 'I_N, ~~ holds (contact_at contacts l) -> 0 <= f l 0.

Hypothesis regular : normals radius contacts q \in unitmx.
Variables load rate f u : 'cV[F]_N.
Hypothesis load_balanced : balanced radius contacts q load f.
Hypothesis rate_balanced : balanced radius contacts q rate u.

Lemma forces_follow_the_load t : balanced radius contacts q (load + t *: rate) (f + t *: u).
Proof.
rewrite /balanced mulmxDr -scalemxAr addrACA.
by rewrite load_balanced add0r -scalerDr rate_balanced scaler0.
Qed.

Let borne_iff t : borne (load + t *: rate) <->
  forall l : 'I_N, ~~ holds (contact_at contacts l) -> 0 <= f l 0 + u l 0 * t.
Proof.
have entry l : (f + t *: u) l 0 = f l 0 + u l 0 * t by rewrite !mxE mulrC.
split=> [[g /(balancing_forces_are_unique regular (forces_follow_the_load t)) <- pushing] l|pushing].
  by rewrite -entry; apply: pushing.
by exists (f + t *: u) => [|l]; [exact: forces_follow_the_load|rewrite entry; apply: pushing].
Qed.

Hypothesis pushing : forall l : 'I_N, ~~ holds (contact_at contacts l) -> 0 <= f l 0.

(** [mute]: contacts that bear nothing at the end. [free]: degrees of freedom without load that no other contact
    touches. *)
Variables mute free : {set 'I_N}.
Hypothesis untouched : forall k l : 'I_N, k \in free -> l \notin mute -> (k : nat) \notin coordinates d n (contact_at contacts l).
Hypothesis free_of_rate : forall k, k \in free -> rate k 0 = 0.

Let X_zero (k l : 'I_N) : k \in free -> l \notin mute -> (normals radius contacts q)^T k l = 0.
Proof. by move=> kf lm; apply: untouched_entry (untouched kf lm). Qed.

Let free_forces (p g : 'cV[F]_N) : balanced radius contacts q p g -> (forall k, k \in free -> p k 0 = 0) ->
  forall k, k \in free -> ((normals radius contacts q)^T *m g) k 0 = 0.
Proof.
move=> b zero k kf; have -> : (normals radius contacts q)^T *m g = - p by apply/eqP; rewrite -addr_eq0; apply/eqP.
by rewrite mxE zero ?oppr0.
Qed.

Section End.
Variable m : 'I_N.
Hypothesis more : #|mute| = #|free|.+1.
Hypothesis free_of_load : forall k, k \in free -> load k 0 = 0.
Hypothesis m_mute : m \in mute.
Hypothesis m_touches : ~~ holds (contact_at contacts m).
Hypothesis m_pushes : 0 < f m 0.
Hypothesis m_falls : u m 0 < 0.
Hypothesis others : forall l : 'I_N, l \notin mute -> ~~ holds (contact_at contacts l) -> 0 < f m 0 * u l 0 - f l 0 * u m 0.
Let t1 := f m 0 / - u m 0.

(** Beyond t1 the force of m would pull. At t1 those of [mute] are 0 and all others push. *)
Theorem the_load_is_borne_up_to_its_end : [/\ 0 < t1,
  forall t, 0 <= t -> borne (load + t *: rate) <-> t <= t1,
  forall l, l \in mute -> (f + t1 *: u) l 0 = 0
  & forall l : 'I_N, l \notin mute -> ~~ holds (contact_at contacts l) -> 0 < (f + t1 *: u) l 0].
Proof.
have um : 0 < - u m 0 by rewrite oppr_gt0.
have entry l : (f + t1 *: u) l 0 = f l 0 + u l 0 * t1 by rewrite !mxE mulrC.
have unit : (normals radius contacts q)^T \in unitmx by rewrite unitmx_tr.
have mutes l : l \in mute -> (f + t1 *: u) l 0 = 0.
  apply: (block_solutions_vary_together unit X_zero more _ (free_forces load_balanced free_of_load) m_mute).
  - apply: free_forces (forces_follow_the_load t1) _ => k kf.
    by rewrite !mxE free_of_load ?free_of_rate // mulr0 addr0.
  - by rewrite gt_eqF.
  by rewrite entry /t1 mulrCA invrN !mulrN mulfV ?lt_eqF // mulr1 subrr.
have louder (l : 'I_N) : l \notin mute -> ~~ holds (contact_at contacts l) -> 0 < (f + t1 *: u) l 0.
  move=> lm /(others lm); rewrite entry; have -> : f l 0 + u l 0 * t1 = (f m 0 * u l 0 - f l 0 * u m 0) / - u m 0.
    by rewrite /t1; field; rewrite lt_eqF.
  by move=> num; apply: divr_gt0.
split=> // [|t t0]; first exact: divr_gt0.
pose touching (x : 'cV[F]_N) (l : 'I_N) := if holds (contact_at contacts l) then 0 else x l 0.
have [|||least most] := @supported_interval_ends_at_the_smallest_ratio F N (touching f) (touching u) m t _ _ _ t0.
- by move=> l; rewrite /touching; case: ifPn => // /pushing.
- by rewrite /touching (negPf m_touches).
- move=> l; rewrite /touching (negPf m_touches); case: ifPn => [_|touch ul]; first by rewrite ltxx.
  rewrite -nonnegative_up_to_the_ratio // -entry.
  by have [/mutes->|/louder/(_ touch)/ltW] := boolP (l \in mute).
rewrite /touching (negPf m_touches) -/t1 in least most.
rewrite borne_iff; split=> [all|/most all l touch]; last by have := all l; rewrite (negPf touch).
by apply: least => l; case: ifPn => [_|/all //]; rewrite mul0r addr0.
Qed.
End End.

(** Without a force that falls there is no end. *)
Theorem the_load_is_borne_without_end : #|mute| = #|free| -> (forall l : 'I_N, l \notin mute -> ~~ holds (contact_at contacts l) -> 0 < u l 0) ->
  forall t, 0 <= t -> borne (load + t *: rate).
Proof.
move=> same rising t t0; apply/borne_iff => l touch; apply: addr_ge0; first exact: pushing.
apply: mulr_ge0 => //; have [lm|/rising/(_ touch)/ltW //] := boolP (l \in mute).
by rewrite (structural_zeros regular rate_balanced (esym same) free_of_rate untouched lm).
Qed.
End Load.

Print Assumptions the_load_is_borne_up_to_its_end.
Print Assumptions the_load_is_borne_without_end.
