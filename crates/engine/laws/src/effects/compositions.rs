//! Every composition of effects that scenes can ask for.

/// Every composition of effects, as the parts of a name and its type: given to the macro that is named.
///
/// First those that most scenes have ([`Description::every_precision`]); then each normal law, adhering or not, with each choice for the other slots.
#[macro_export]
macro_rules! compositions {
    ($then:ident) => { $crate::effects!(@ [$crate::compositions] @of $then); };
    (@of $then:ident
     normal: $($nm:ident :: $normal:ident),*; cohesion: $am:ident :: $adhesion:ident;
     sliding: $sm:ident :: $sliding:ident <$of:ident :: $model:ident>;
     rolling: $($rm:ident :: $rolling:ident),*; twisting: $tm:ident :: $twisting:ident;) => {
        $crate::compositions!(@laws $then [
            [common hooke] $crate::effects::Hooke;
            [common hooke sliding] ($crate::effects::Hooke, $crate::effects::SlidingFriction);
            [common hooke sliding rolling] ($crate::effects::Hooke, ($crate::effects::SlidingFriction, $crate::effects::RollingResistance));
            [common hertz] $crate::effects::Hertz;
            [common hertz sliding] ($crate::effects::Hertz, $crate::effects::SlidingFriction);
            [common hertz sliding rolling] ($crate::effects::Hertz, ($crate::effects::SlidingFriction, $crate::effects::RollingResistance));
        ] [$([$nm ($crate::effects::$normal, Option<$crate::effects::$adhesion>)])*]
        [$sm $crate::effects::$sliding<$crate::effects::$model>, $tm $crate::effects::$twisting $(, $rm $crate::effects::$rolling)*]);
    };
    (@laws $then:ident [$($done:tt)*] [] $others:tt) => { $then! { $($done)* } };
    (@laws $then:ident [$($done:tt)*] [[$nm:ident $law:tt] $($more:tt)*]
     [$sm:ident $sliding:ty, $tm:ident $twisting:ty $(, $rm:ident $rolling:ty)*]) => {
        $crate::compositions!(@laws $then [
            $($done)*
            [$nm] $law;
            [$nm $sm] ($law, $sliding);
            [$nm $sm $tm] (($law, $sliding), $twisting);
            $([$nm $sm $rm] (($law, $sliding), $rolling);
            [$nm $sm $rm $tm] ((($law, $sliding), $rolling), $twisting);)*
        ] [$($more)*] [$sm $sliding, $tm $twisting $(, $rm $rolling)*]);
    };
}
