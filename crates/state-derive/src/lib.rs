//! `#[derive(Stateful)]` for `servobench_base::state::Stateful`, where the attributes are described.
//!
//! Every field is saved and restored in the order of the declaration, unless it is marked; a field of a type that is not a state does
//! not compile. A variant of an enum is written by its index.
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use syn::parse::Parser as _;
use syn::punctuated::Punctuated;
use syn::{Attribute, Data, DataEnum, DeriveInput, Error, Fields, Token, parse_macro_input};

/// See the module `servobench_base::state`.
#[proc_macro_derive(Stateful, attributes(state))]
pub fn derive_state(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    implementation(&input).unwrap_or_else(Error::into_compile_error).into()
}

/// Mark of a field: `#[state(constant)]` and the like.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    /// Part of the state.
    None,
    /// A parameter: neither saved nor restored.
    Constant,
    /// Computed from the rest of the state.
    Derived,
    /// An option, a list or an enum whose form the parameters decide.
    Fixed,
}

fn mark(attributes: &[Attribute]) -> Result<Mark, Error> {
    let mut mark = Mark::None;
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("state")) {
        let words = Punctuated::<Ident, Token![,]>::parse_terminated;
        for word in words.parse2(attribute.meta.require_list()?.tokens.clone())? {
            let read = match word.to_string().as_str() {
                "constant" => Mark::Constant,
                "derived" => Mark::Derived,
                "fixed" => Mark::Fixed,
                _ => return Err(Error::new(word.span(), "not a mark of a state: use constant, derived or fixed")),
            };
            if mark != Mark::None {
                return Err(Error::new(word.span(), "a field has one mark"));
            }
            mark = read;
        }
    }
    Ok(mark)
}

/// The statements that save and restore some fields, each of which is bound to a reference of its name.
#[derive(Default)]
struct Statements {
    save: TokenStream,
    restore: TokenStream,
    bindings: Vec<Ident>,
}

fn statements(fields: &Fields) -> Result<Statements, Error> {
    let mut all = Statements::default();
    for (index, field) in fields.iter().enumerate() {
        let binding = field.ident.clone().unwrap_or_else(|| format_ident!("field_{index}"));
        let name = field.ident.as_ref().map_or_else(|| index.to_string(), ToString::to_string);
        let (part, save, restore) = match mark(&field.attrs)? {
            Mark::Constant => {
                let ignored = quote!(let _ = #binding;);
                all.save.extend(ignored.clone());
                all.restore.extend(ignored);
                all.bindings.push(binding);
                continue;
            }
            Mark::None => (quote!(field), quote!(Stateful::save), quote!(Stateful::restore)),
            Mark::Derived => (quote!(derived), quote!(Stateful::save), quote!(Stateful::restore)),
            Mark::Fixed => (quote!(field), quote!(FixedForm::save_fixed), quote!(FixedForm::restore_fixed)),
        };
        all.save.extend(quote! {
            to.enter(::servobench_base::state::Part::#part(#name));
            ::servobench_base::state::#save(#binding, to);
            to.leave();
        });
        all.restore.extend(quote!(::servobench_base::state::#restore(#binding, from)?;));
        all.bindings.push(binding);
    }
    Ok(all)
}

fn pattern(fields: &Fields, bindings: &[Ident]) -> TokenStream {
    match fields {
        Fields::Named(_) => quote!({ #(#bindings),* }),
        Fields::Unnamed(_) => quote!(( #(#bindings),* )),
        Fields::Unit => quote!(),
    }
}

fn implementation(input: &DeriveInput) -> Result<TokenStream, Error> {
    let (save, restore) = match &input.data {
        Data::Struct(data) => {
            let Statements { save, restore, bindings } = statements(&data.fields)?;
            let pattern = pattern(&data.fields, &bindings);
            (quote!(let Self #pattern = self; #save), quote!(let Self #pattern = self; #restore))
        }
        Data::Enum(data) => of_enum(data, mark(&input.attrs)? == Mark::Fixed)?,
        Data::Union(data) => return Err(Error::new(data.union_token.span, "a union is not a state")),
    };
    let (name, (generics, arguments, bounds)) = (&input.ident, input.generics.split_for_impl());
    Ok(quote! {
        #[automatically_derived]
        impl #generics ::servobench_base::state::Stateful for #name #arguments #bounds {
            fn save(&self, to: &mut dyn ::servobench_base::state::Writer) {
                #save
            }
            fn restore(
                &mut self,
                from: &mut ::servobench_base::state::Reader<'_>,
            ) -> Result<(), ::servobench_base::state::Damaged> {
                #restore
                Ok(())
            }
        }
    })
}

fn of_enum(data: &DataEnum, is_fixed: bool) -> Result<(TokenStream, TokenStream), Error> {
    let (mut save, mut begin, mut restore) = (TokenStream::new(), TokenStream::new(), TokenStream::new());
    for (index, variant) in (0_u64..).zip(&data.variants) {
        let fields = statements(&variant.fields)?;
        let (name, pattern) = (&variant.ident, pattern(&variant.fields, &fields.bindings));
        let (save_fields, restore_fields) = (fields.save, fields.restore);
        save.extend(quote!(Self::#name #pattern => { to.word(#index); #save_fields }));
        restore.extend(quote!(Self::#name #pattern => { #restore_fields }));
        let is_it = quote!(matches!(self, Self::#name { .. }));
        begin.extend(if is_fixed {
            quote!(#index if #is_it => {})
        } else {
            let values = match &variant.fields {
                Fields::Named(named) => {
                    let names = named.named.iter().map(|field| &field.ident);
                    quote!({ #(#names: ::core::default::Default::default()),* })
                }
                Fields::Unnamed(unnamed) => {
                    let values = unnamed.unnamed.iter().map(|_| quote!(::core::default::Default::default()));
                    quote!(( #(#values),* ))
                }
                Fields::Unit => quote!(),
            };
            quote!(#index => if !#is_it { *self = Self::#name #values; })
        });
    }
    let begin = quote!(match from.word()? { #begin _ => return Err(::servobench_base::state::Damaged), });
    Ok((quote!(match self { #save }), quote!(#begin match self { #restore })))
}
